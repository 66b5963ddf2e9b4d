// SPDX-License-Identifier: MIT
/// The two sides of a WebSocket, independent of the WebSocket library.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "admission.hpp"

namespace hapticd::view {

/// Bytes that are sent to one or several peers.
using Message = std::shared_ptr<const std::string>;

/// The connection to a page or program, as a conversation sees it.
class Peer {
 public:
  virtual ~Peer() = default;
  /// [main] Sends a text (JSON) after all waiting messages. If more than kMostWaiting bytes wait, the connection ends.
  virtual void text(std::string json) = 0;
  virtual void binary(Message bytes) = 0;  ///< [main] sends bytes in the same way
  /// [main] Tells whether no message waits to be sent. The newest values are sent only then, so that a slow reader
  /// skips some.
  virtual bool idle() const = 0;

  static constexpr size_t kMostWaiting = 64u << 20;  ///< [bytes] enough for the meshes of a large scene
};

/// The protocol over one connection. It is made when the connection opens, and destroyed after the connection has
/// ended.
class PeerSession {
 public:
  PeerSession() = default;
  virtual ~PeerSession() = default;
  PeerSession(const PeerSession&) = delete;
  PeerSession& operator=(const PeerSession&) = delete;

  virtual void onText(std::string_view text) = 0;               ///< [main] a text message came
  virtual void onBinary(std::span<const std::byte> bytes) = 0;  ///< [main] a binary message came
  virtual void onTick() = 0;                                    ///< [main] 60 times per second: sends newest values
};

}  // namespace hapticd::view
