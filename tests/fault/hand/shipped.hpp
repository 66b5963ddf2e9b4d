// SPDX-License-Identifier: MIT
/// Models of the plugins that ship, from the text of a scene.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/catalog.hpp"
#include "scene/load.hpp"

namespace hapticd::servo {

/// A scene. @param text of the file; HERE stands for the folder config
inline scene::Scene shippedScene(std::string text) {
  for (size_t at; (at = text.find("HERE")) != std::string::npos;) text.replace(at, 4, HAPTICD_SOURCE_DIR "/config");
  const auto file = std::filesystem::temp_directory_path() / ("hapticd-shipped-" + std::to_string(getpid()) + ".yaml");
  std::ofstream(file) << "hapticd: 1\nservo: {rate: 1000}\n" << text;
  host::Catalog catalog{host::SearchPath{{SHIPPED_MODULES "/plugins"}, {SHIPPED_MODULES "/devices"}}};
  auto loaded = scene::load(file, catalog, {false, {}});
  std::filesystem::remove(file);
  for (const document::Problem& problem : loaded.problems) ADD_FAILURE() << problem.text();
  if (!loaded.scene) throw std::runtime_error("no scene");
  return std::move(*loaded.scene);
}

/// @param models the list under the key models
inline std::vector<scene::Model> shipped(const std::string& models) {
  return shippedScene("models:\n" + models).models;
}

}  // namespace hapticd::servo
