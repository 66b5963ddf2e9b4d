// SPDX-License-Identifier: MIT
/// The two ends of a WebSocket: the peer (a page or a program) and the session that talks to it. Neither depends on the
/// WebSocket library.
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

/// The connection to a page or program, as a PeerSession uses it.
class Peer {
 public:
  virtual ~Peer() = default;
  /// [main] Sends a text (JSON) after all waiting messages. If then more than kMostWaiting bytes wait, the connection
  /// is closed.
  virtual void text(std::string json) = 0;
  virtual void binary(Message bytes) = 0;  ///< [main] sends bytes in the same way
  /// [main] True if no message waits to be sent. New values are sent only then, so that a slow reader skips old values.
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
