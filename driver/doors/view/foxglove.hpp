// SPDX-License-Identifier: MIT
/// Foxglove's WebSocket protocol (github.com/foxglove/ws-protocol, version 1), read-only. It has one channel for each
/// stream of rows, /tf for the poses of models and tips, and /scene for the triangles.
#pragma once
#include <memory>

#include "peer.hpp"
#include "stage.hpp"

namespace hapticd::view {

/// [main] Both arguments must outlive the session.
std::unique_ptr<PeerSession> startFoxgloveSession(Peer& peer, Stage& stage);

}  // namespace hapticd::view
