// SPDX-License-Identifier: MIT
/// Programs of another user: the daemon may be allowed to read what that user is not, so they pass their files open.
#pragma once
#include "base/passed_files.hpp"
#include "control/peer.hpp"
#include "description/scene.hpp"

namespace hapticd::servo {

/// [any] True if the peer has rights of its own, so that what the daemon may read is not meant for it.
bool isForeign(const control::Peer& peer);

/// [main] The model with paths that a plugin can open: those of copies of the passed files.
scene::Model withPaths(scene::Model model, const PassedFiles& files);

}  // namespace hapticd::servo
