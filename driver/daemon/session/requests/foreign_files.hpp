// SPDX-License-Identifier: MIT
/// Files of programs of another user. The daemon may have the right to read files that this user must not read. So such
/// programs open their files themselves and send the descriptors.
#pragma once
#include "base/passed_files.hpp"
#include "control/peer.hpp"
#include "description/scene.hpp"

namespace hapticd::servo {

/// [any] True if the peer is neither the daemon's user nor root, so that the daemon must not open files for it.
bool isForeign(const control::Peer& peer);

/// [main] Returns the model with file names that a plugin can open: they name copies of the files that were sent.
scene::Model withPaths(scene::Model model, const PassedFiles& files);

}  // namespace hapticd::servo
