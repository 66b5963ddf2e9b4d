// SPDX-License-Identifier: MIT
/// Parses and writes JSON with the library nlohmann/json. Its parser adds more than a second to the compilation of each
/// source file that calls it, so only json_text.cpp does. For a tree with the line and column of every value, use
/// document::Node.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace hapticd::document {

/// [any] Parses a text; keys keep their order. If the text is not JSON, is_discarded() of the result is true.
nlohmann::ordered_json parseJson(std::string_view text);

/// [any] Does what parseJson() does, but throws nlohmann::json::parse_error if the text is not JSON.
nlohmann::ordered_json parseJsonOrThrow(std::string_view text);

/// [any] Returns JSON as one line of text. Bytes that are not UTF-8 are replaced.
std::string jsonLine(const nlohmann::ordered_json& json);

/// [any] Returns JSON as indented lines of text, without the last line break. Bytes that are not UTF-8 are replaced.
std::string jsonLines(const nlohmann::ordered_json& json);

}  // namespace hapticd::document
