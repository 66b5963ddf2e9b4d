// SPDX-License-Identifier: MIT
/// nlohmann's JSON from text. Its parser costs a unit that calls it more than a second of compiling, so one calls it
/// for all. A tree that knows the place of every value is document::Node.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace hapticd::document {

/// [any] Keys keep their order. Gives a value that is_discarded() if the text is not JSON.
nlohmann::ordered_json parseJson(std::string_view text);

/// [any] As parseJson(), but throws nlohmann::json::parse_error if the text is not JSON.
nlohmann::ordered_json parseJsonOrThrow(std::string_view text);

}  // namespace hapticd::document
