// SPDX-License-Identifier: MIT
/// Scene, device and daemon files into checked descriptions. All problems are collected, never only the first.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"
#include "scene/daemon.hpp"

namespace hapticd::scene {

using document::Problems;

/// What is to be done with the scene's devices.
struct LoadOptions {
  /// False: with no device named, none is taken either (`hapticd trace` needs no arm).
  bool default_device = true;
  /// Replaces the devices that the scene names; empty: the scene's own are used.
  std::filesystem::path device_file;
};

struct Loaded {
  std::optional<Scene> scene;  ///< nothing if there are problems
  Problems problems;
};
struct LoadedDevice {
  std::optional<Device> device;
  Problems problems;
};
struct LoadedDaemon {
  std::optional<Daemon> daemon;
  Problems problems;
};

/// [main] A scene file with everything it names: device files, parameters against the plugins' tables, paths.
Loaded load(const std::filesystem::path& file, host::Catalog& catalog, const LoadOptions& options = {});

/// [main] A device file.
LoadedDevice loadDevice(const std::filesystem::path& file, host::Catalog& catalog);

/// [main] A daemon file.
LoadedDaemon loadDaemon(const std::filesystem::path& file);

/// [main] Loads any of the three formats, told apart by their first key. Used by `hapticd check`.
/// @param scene receives a scene without problems; nullptr: not wanted
Problems checkFile(const std::filesystem::path& file, host::Catalog& catalog, std::optional<Scene>* scene = nullptr);

/// [main] The same for a text; `file` gives messages its name and paths their folder. Fuzzing starts here.
Problems checkText(const std::string& text, const std::filesystem::path& file, host::Catalog& catalog,
                   std::optional<Scene>* scene = nullptr);

/// [main] JSON Schema of a format ("scene", "device", "daemon"), for editors; "" for any other name.
/// With a catalog, the parameters of every plugin found are part of it.
std::string jsonSchema(const std::string& format, host::Catalog* catalog);

/// The device file that is used for a scene without one.
constexpr const char* kDefaultDevice = "devices/simulated-premium15.yaml";

}  // namespace hapticd::scene
