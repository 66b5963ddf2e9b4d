// SPDX-License-Identifier: MIT
/// The parts of loading that scene, device and daemon files share. Inside driver/daemon/scene only.
#pragma once
#include <optional>
#include <string>

#include "host/catalog.hpp"
#include "scene/format.hpp"
#include "scene/load.hpp"

namespace hapticd::scene::detail {

using document::Reader;

/// The format whose key the document has, or nullptr.
const Format* formatOf(const Node& root);

/// True if the document has the wanted format; otherwise a problem says what it is and what was expected.
bool hasFormat(const Node& root, const char* wanted, Reader& in);

/// Reads what a scene file's tree says. Problems go to `in`.
std::optional<Scene> loadScene(const Node& root, Reader& in, host::Catalog& catalog, const LoadOptions& options);

/// One device from its file, with what a scene says otherwise.
/// @param scene_in reader of the scene that overrides; @param hand the scene's `hand:` for all its devices
std::optional<Device> loadDeviceFile(const DeviceReference& reference, host::Catalog& catalog, Problems& problems,
                                     Reader* scene_in, const Node* hand, bool* has_hand);

/// Reads what a device file's tree says.
std::optional<Device> loadDevice(const Node& root, Reader& in, const DeviceReference& reference, host::Catalog& catalog,
                                 Reader* scene_in, const Node* hand, bool* has_hand);

std::optional<Daemon> loadDaemon(const Node& root, Reader& in);

}  // namespace hapticd::scene::detail
