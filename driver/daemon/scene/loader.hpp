// SPDX-License-Identifier: MIT
/// Functions that the loaders of scene, device and daemon files share. Only for driver/daemon/scene.
#pragma once
#include <optional>

#include "host/catalog.hpp"
#include "scene/format.hpp"
#include "scene/load.hpp"

namespace hapticd::scene::detail {

using document::Reader;

/// Returns the format whose version key the document has, or nullptr.
const Format* formatOf(const Node& root);

/// Returns true for a file without a version, or with that of a scene, that only a device file can be.
bool isMeantAsDevice(const Node& root);

/// Returns true if the document has the wanted format; otherwise reports what the document is and what was expected.
bool hasFormat(const Node& root, const char* wanted, Reader& in);

/// Reads the tree of a scene file. Problems go to `in`.
std::optional<Scene> loadScene(const Node& root, Reader& in, host::Catalog& catalog, const LoadOptions& options);

/// Reads a device file. Settings that the scene gives replace those of the file.
/// @param scene_in reader of the scene; nullptr if no scene names the device
/// @param hand the value of `hand:` in the scene, which is for all its devices; nullptr if there is none
/// @param has_hand receives whether the module has a simulated hand; may be nullptr
std::optional<Device> loadDeviceFile(const DeviceReference& reference, host::Catalog& catalog, Problems& problems,
                                     Reader* scene_in, const Node* hand, bool* has_hand);

/// Reads the tree of a device file.
std::optional<Device> loadDevice(const Node& root, Reader& in, const DeviceReference& reference, host::Catalog& catalog,
                                 Reader* scene_in, const Node* hand, bool* has_hand);

/// Reads the tree of a device file whose version is wrong or missing, so that its other problems are found, too.
std::optional<Device> loadMeantDevice(const Node& root, Reader& in, const DeviceReference& reference,
                                      host::Catalog& catalog);

std::optional<Daemon> loadDaemon(const Node& root, Reader& in);

}  // namespace hapticd::scene::detail
