// SPDX-License-Identifier: MIT
/// The control socket of a running daemon (see control.md). Requests do not wait for their answers, so that rows can be
/// sent in the meantime.
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
  /// Called with the answer and the memory file that came with it. If no answer came, the answer is {"ok": false,
  /// "error": ...}.
  using Answered = std::function<void(const Json& answer, const Descriptor& memory)>;

  virtual ~Daemon() = default;
  /// [main] Sends a request. It never waits; `answered` is called later. Requests are answered in order.
  virtual void ask(const Json& request, Answered answered) = 0;
  virtual bool connected() const = 0;  ///< [main]
  virtual void connect() = 0;          ///< [main] tries to connect again if there is no connection

  /// [main] @param file the socket, which need not exist yet
  static std::unique_ptr<Daemon> at(boost::asio::io_context& io, std::string file);
};

}  // namespace hapticd::view
