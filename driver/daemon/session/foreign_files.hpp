// SPDX-License-Identifier: MIT
/// Files that a program of another user names: the daemon may be allowed to read what that user is not.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "control/peer.hpp"
#include "description/scene.hpp"

namespace hapticd::servo {

/// [any] The peer has rights of its own, so that what the daemon may read is none of its business.
bool isForeign(const control::Peer& peer);

/// [main] Files that the models of a scene name, beside the scene's own.
std::vector<std::string> filesOf(const std::vector<scene::Model>& models);

/// [main] Nothing, or the first that is no regular file that every user may read. Nothing of what it holds is told.
Result<void> readableByAll(const std::vector<std::string>& files);

}  // namespace hapticd::servo
