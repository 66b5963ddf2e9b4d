// SPDX-License-Identifier: MIT
/// Reads a capture or a table of joints, which may also come from a pipe or from standard input.
#pragma once
#include <string>

#include "base/result.hpp"

namespace hapticd::cli {

/// [main] Returns the whole content of a file or a pipe, or of standard input ("-"): at most 256 MiB, because some
/// sources never end. The text of an error begins with what is wrong, without the name of the file.
Result<std::string> contentOf(const std::string& file);

}  // namespace hapticd::cli
