// SPDX-License-Identifier: MIT
/// The control socket of a running daemon (see control.md), asked without waiting: an answer comes when it comes, and
/// rows go on meanwhile.
#pragma once
#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/descriptors.hpp"

namespace hapticd::view {

using Json = nlohmann::ordered_json;

class Daemon {
 public:
  /// The answer, or {"ok": false, "error": ...} if there is none, and the memory file that came with it.
  using Answered = std::function<void(const Json& answer, const Descriptor& memory)>;

  virtual ~Daemon() = default;
  /// [main] Sends a request; requests are answered in order. It never waits, and calls back later, not at once.
  virtual void ask(const Json& request, Answered answered) = 0;
  virtual bool connected() const = 0;  ///< [main]
  virtual void connect() = 0;          ///< [main] tries to connect again if there is no connection

  /// [main] @param file the socket, which need not exist yet
  static std::unique_ptr<Daemon> at(boost::asio::io_context& io, std::string file);
};

}  // namespace hapticd::view
