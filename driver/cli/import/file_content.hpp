// SPDX-License-Identifier: MIT
/// Recognises what a file to import holds by its first bytes, if its name says something else.
#pragma once
#include <string>

namespace hapticd::cli {

/// [main] Returns what is wrong if a file is empty, or if its first bytes are those of another kind of file than its
/// name says, with how to fix it; "" if they agree, or if the bytes say nothing. The text begins with the file's name.
std::string misnamed(const std::string& file);

}  // namespace hapticd::cli
