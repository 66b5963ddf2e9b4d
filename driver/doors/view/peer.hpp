// SPDX-License-Identifier: MIT
/// Both sides of a WebSocket, free of the library that carries it.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "admission.hpp"

namespace hapticd::view {

/// Bytes on their way to several peers at once.
using Message = std::shared_ptr<const std::string>;

/// The connection, as a conversation sees it.
class Peer {
 public:
  virtual ~Peer() = default;
  /// [main] Sends text (JSON) after everything that waits. If more than kMostWaiting bytes wait, the connection ends.
  virtual void text(std::string json) = 0;
  virtual void binary(Message bytes) = 0;  ///< [main] sends bytes in the same way
  /// [main] True if nothing waits to be sent: newest values sent only then skip what a slow reader cannot take.
  virtual bool idle() const = 0;

  static constexpr size_t kMostWaiting = 64u << 20;  ///< [bytes] size of the meshes of a large scene
};

/// What is said over a connection: it is made when that opens, and destroyed when it has ended.
class Conversation {
 public:
  Conversation() = default;
  virtual ~Conversation() = default;
  Conversation(const Conversation&) = delete;
  Conversation& operator=(const Conversation&) = delete;

  virtual void onText(std::string_view text) = 0;               ///< [main] a message came
  virtual void onBinary(std::span<const std::byte> bytes) = 0;  ///< [main] the same
  virtual void onTick() = 0;                                    ///< [main] 60 times per second: sends newest values
};

}  // namespace hapticd::view
