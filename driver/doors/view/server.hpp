// SPDX-License-Identifier: MIT
/// HTTP and WebSocket on the loopback interface, with these limits: 8 KiB for the head of a request, 10 s for its
/// arrival, 64 KiB per message, 8 WebSockets, 32 connections; one more ends the one that is silent longest. Only
/// server.cpp uses Boost.Beast.
#pragma once
#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "admission.hpp"
#include "base/result.hpp"
#include "peer.hpp"

namespace hapticd::view {

/// A file of the page.
struct Asset {
  std::string_view type;  ///< Content-Type
  std::string_view bytes;
};

/// [main] Returns the file of the page at this path; `bytes` is empty if there is no such file.
Asset assetOf(const std::string& path);

class Server {
 public:
  static constexpr size_t kMostSockets = 8, kMostConnections = 32;

  /// Makes the session of a new WebSocket. `peer` outlives the session.
  using Converse = std::function<std::unique_ptr<PeerSession>(Subprotocol, Peer& peer)>;

  /// [main] Listens on 127.0.0.1 and, if it exists, on ::1. @param port 0 for any free port
  static Result<std::unique_ptr<Server>> listen(boost::asio::io_context& io, unsigned short port, Converse converse);
  virtual ~Server() = default;
  Server() = default;
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  virtual std::string url() const = 0;  ///< [main] address of the page, with the token
  virtual size_t sockets() const = 0;   ///< [main] number of open WebSockets
  virtual void tick() = 0;              ///< [main] calls onTick() of every session
};

}  // namespace hapticd::view
