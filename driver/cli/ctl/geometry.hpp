// SPDX-License-Identifier: MIT
/// `hapticd ctl geometry`: the triangles of a model.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace hapticd::cli {

/// [s] How long to wait for triangles: a part of tens of millions takes the daemon some seconds, the more so if several
/// drawings are tried.
constexpr double kDrawingPatience = 60;

/// [main] Asks the daemon for triangles in memory, which has room for more of them than an answer, and writes them as
/// an OBJ file. @param request of the word "geometry" @return exit code
int saveGeometry(const std::string& socket, nlohmann::ordered_json request, const std::string& file);

}  // namespace hapticd::cli
