// SPDX-License-Identifier: MIT
#include "session/requests/kept_settings.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "document/json_text.hpp"
#include "record/scene_json.hpp"

namespace hapticd::servo {

namespace {

using Json = nlohmann::ordered_json;

/// Turns a list of parameters into an object by their names, so that the order in the file does not matter.
Json byName(const Json& values) {
  Json named = Json::object();
  for (const Json& value : values)
    named[value.at("id").get<std::string>()] = {value.at("number"), value.at("text"), value.at("numbers")};
  return named;
}

/// Collects the keys whose values differ between two objects, also in objects within them.
void compare(const Json& a, const Json& b, const std::string& prefix, std::set<std::string>& found) {
  if (a == b) return;
  if (!a.is_object() || !b.is_object()) {
    found.insert(prefix);
    return;
  }
  Json all = a;
  all.update(b);
  for (const auto& [key, value] : all.items()) {
    const char* gap = prefix.empty() || prefix.ends_with(": ") ? "" : ".";
    compare(a.value(key, Json()), b.value(key, Json()), prefix + gap + key, found);
  }
}

void compareDevices(Json a, Json b, std::set<std::string>& found) {
  const std::string name = a.at("name").get<std::string>() + ": ";
  compare(byName(a.at("parameters")), byName(b.at("parameters")), name, found);
  for (Json* device : {&a, &b}) {
    device->erase("parameters");
    device->erase("library");
  }
  compare(a, b, name, found);
}

}  // namespace

std::vector<std::string> keptSettings(const scene::Scene& running, const scene::Scene& wanted) {
  const Json a = document::parseJsonOrThrow(record::sceneToJson(running)),
             b = document::parseJsonOrThrow(record::sceneToJson(wanted));
  std::set<std::string> found;
  compare(a.at("servo"), b.at("servo"), "servo", found);
  compare(a.at("clients"), b.at("clients"), "clients", found);
  for (size_t i = 0; i < std::min(a.at("devices").size(), b.at("devices").size()); ++i)
    compareDevices(a.at("devices")[i], b.at("devices")[i], found);
  return {found.begin(), found.end()};
}

}  // namespace hapticd::servo
