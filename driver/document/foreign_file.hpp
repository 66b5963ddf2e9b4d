// SPDX-License-Identifier: MIT
/// Recognises files of other programs, such as meshes, that people give in place of a YAML file.
#pragma once
#include <string>
#include <string_view>

namespace hapticd::document {

/// [main] Returns what the file is and what to do with it, judged by its name or its first words; "" if it is unknown.
std::string foreignFile(std::string_view text, const std::string& file);

}  // namespace hapticd::document
