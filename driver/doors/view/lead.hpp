// SPDX-License-Identifier: MIT
/// A lead that a page has taken: the memory file of the lead, and a connection to the daemon. The lead lasts as long as
/// this connection.
#pragma once
#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "daemon.hpp"
#include "hapticd/client.h"

namespace hapticd::view {

class Lead {
 public:
  using Taken = std::function<void(const Json& answer)>;

  /// [main] Asks for the lead on a separate connection. The daemon ends the lead when this connection closes, even if
  /// this process is killed.
  /// @param request {"do": "lead", ...}
  /// @param taken called once, with the daemon's answer
  static std::unique_ptr<Lead> ask(boost::asio::io_context& io, const std::string& socket, const Json& request,
                                   Taken taken);
  ~Lead();
  Lead(const Lead&) = delete;
  Lead& operator=(const Lead&) = delete;

  /// [main] Writes a record and never waits. A newer record replaces an older one. @param record the bytes of a
  /// hapticd_target
  /// @return false if the size is wrong, or there is no lead (yet)
  bool put(std::span<const std::byte> record);
  bool refused() const { return refused_; }  ///< [main] true if the daemon refused the lead

 private:
  Lead() = default;
  std::unique_ptr<Daemon> daemon_;
  hapticd_lead_page* page_ = nullptr;
  bool refused_ = false;
};

}  // namespace hapticd::view
