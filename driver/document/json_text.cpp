// SPDX-License-Identifier: MIT
#include "document/json_text.hpp"

#include <nlohmann/json.hpp>

namespace hapticd::document {

nlohmann::ordered_json parseJson(std::string_view text) {
  return nlohmann::ordered_json::parse(text, nullptr, false);
}

nlohmann::ordered_json parseJsonOrThrow(std::string_view text) {
  return nlohmann::ordered_json::parse(text);
}

std::string jsonLine(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string jsonLines(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace hapticd::document
