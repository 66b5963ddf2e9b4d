// SPDX-License-Identifier: MIT
/// Warns of an arm that nobody has placed in the world, or that stands far from the shapes of scenes.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of a device file without `mount` whose arm rests within the shapes about the world's origin, or far
/// from them. Only arms that the file describes are judged, because a module may have its frame where it likes.
void warnOfNoMount(const document::Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                   document::Problems& warnings);

/// [main] Warns of a `mount` with which such an arm rests far from the shapes about the world's origin.
void warnOfFarMount(const document::Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                    document::Problems& warnings);

}  // namespace hapticd::diagnostics
