// SPDX-License-Identifier: MIT
/// Says that a file does not exist, and which file of its folder was probably meant.
#pragma once
#include <filesystem>
#include <string>

namespace hapticd::document {

/// [main] Returns " (did you mean "box.yaml"?)" with the file of the same folder whose name is nearest, or "".
/// @param own file that is not suggested, because it is the one that names the absent file
std::string neighbourMeant(const std::filesystem::path& absent, const std::filesystem::path& own);

/// [main] A daemon knows only the files that were passed to it. Returns its answer with the reason that this process
/// sees: where a file "was not passed along" because it does not exist, the text says so.
std::string withAbsentFiles(std::string answer, const std::filesystem::path& own);

}  // namespace hapticd::document
