// SPDX-License-Identifier: MIT
/// The protocol of the page, "hapticd.1". Text messages are JSON; binary messages are rows and meshes (see mesh.hpp).
///
/// To the page: {"type": "about" | "list" | "status" | "end" | "reset" | "playback", ...}, and {"type": "answer", "id":
/// N, ...}. From the page: requests as in control.md with an "id", and for a recording also play, pause and seek. A
/// page without the right to control may only send status, list, geometry and feature.
#pragma once
#include <memory>

#include "peer.hpp"
#include "stage.hpp"

namespace hapticd::view {

/// [main] Both arguments must outlive the session.
std::unique_ptr<PeerSession> startPageSession(Peer& peer, Stage& stage);

}  // namespace hapticd::view
