// SPDX-License-Identifier: MIT
/// Files of other programs that people name where a YAML file is wanted.
#pragma once
#include <string>
#include <string_view>

namespace hapticd::document {

/// [main] What such a file is and what to do with it, by its name or its first words; "" if it is unknown.
std::string foreignFile(std::string_view text, const std::string& file);

}  // namespace hapticd::document
