// SPDX-License-Identifier: MIT
/// The wire format of a shipped device file, for tests and emulators: the same text that the module gets.
#pragma once
#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>
#include <string>

namespace hapticd::emulator {

inline nlohmann::ordered_json toJson(const YAML::Node& node) {
  if (node.IsMap()) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const auto& entry : node) out[entry.first.as<std::string>()] = toJson(entry.second);
    return out;
  }
  if (node.IsSequence()) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const auto& item : node) out.push_back(toJson(item));
    return out;
  }
  return node.as<std::string>("");
}

/// `parameters.wire` of a device file as JSON text.
inline std::string wireOf(const std::string& file) {
  return toJson(YAML::LoadFile(file)["parameters"]["wire"]).dump();
}

/// Joints of the arm of a device file that has a wire format: of its chain, or three.
inline size_t jointsOf(const std::string& file) {
  const YAML::Node arm = YAML::LoadFile(file)["parameters"]["arm"];
  return arm["dh"] ? arm["dh"].size() + arm["others"].as<size_t>(0) : 3;
}

}  // namespace hapticd::emulator
