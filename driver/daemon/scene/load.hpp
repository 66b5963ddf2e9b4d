// SPDX-License-Identifier: MIT
/// Reads scene, device and daemon files into checked descriptions. All problems of a file are reported, not only the
/// first.
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

/// Options for the devices of a scene.
struct LoadOptions {
  /// True: a scene that names no device gets the default device. False: such a scene gets no device (`hapticd trace`
  /// needs no arm).
  bool default_device = true;
  /// A device file that replaces the scene's devices. If it is empty, the scene's own devices are used.
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

/// [main] Reads a scene file and everything that it names: device files, paths, and parameters, which are checked
/// against the plugins' tables.
Loaded load(const std::filesystem::path& file, host::Catalog& catalog, const LoadOptions& options = {});

/// [main] Reads a device file.
LoadedDevice loadDevice(const std::filesystem::path& file, host::Catalog& catalog);

/// [main] Reads a daemon file.
LoadedDaemon loadDaemon(const std::filesystem::path& file);

/// [main] Reads a file of any of the three formats, which it recognises by their version keys. For `hapticd check`.
/// @param scene receives the scene if the file is a scene without problems; may be nullptr
Problems checkFile(const std::filesystem::path& file, host::Catalog& catalog, std::optional<Scene>* scene = nullptr);

/// [main] Like checkFile(), but reads a text; fuzzing calls it. `file` is the name that messages give, and relative
/// paths begin at its folder.
Problems checkText(const std::string& text, const std::filesystem::path& file, host::Catalog& catalog,
                   std::optional<Scene>* scene = nullptr);

/// [main] Returns the JSON Schema of a format ("scene", "device" or "daemon"), for editors; "" for any other name.
/// If a catalog is given, the schema contains the parameters of every plugin that was found.
std::string jsonSchema(const std::string& format, host::Catalog* catalog);

/// The device file for a scene that names no device.
constexpr const char* kDefaultDevice = "devices/simulated-premium15.yaml";

}  // namespace hapticd::scene
