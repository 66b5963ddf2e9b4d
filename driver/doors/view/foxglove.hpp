// SPDX-License-Identifier: MIT
/// Foxglove's WebSocket protocol (github.com/foxglove/ws-protocol, version 1), to read only: a channel for each stream
/// of rows, /tf for models and tips, /scene for the triangles.
#pragma once
#include <memory>

#include "peer.hpp"
#include "stage.hpp"

namespace hapticd::view {

/// [main] Both arguments outlive the conversation.
std::unique_ptr<Conversation> converseInFoxglove(Peer& peer, Stage& stage);

}  // namespace hapticd::view
