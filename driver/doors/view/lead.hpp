// SPDX-License-Identifier: MIT
/// A lead that a page has taken: the memory file that the daemon handed out, and the connection that it lives with.
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

  /// [main] Asks on a connection of its own: the daemon ends the lead when that closes, however this process ends.
  /// @param request {"do": "lead", ...} @param taken the daemon's answer, once
  static std::unique_ptr<Lead> ask(boost::asio::io_context& io, const std::string& socket, const Json& request,
                                   Taken taken);
  ~Lead();
  Lead(const Lead&) = delete;
  Lead& operator=(const Lead&) = delete;

  /// [main] Newest wins; nothing waits. @param record the bytes of a hapticd_target. False if its size is impossible,
  /// or there is no lead (yet)
  bool put(std::span<const std::byte> record);
  bool refused() const { return refused_; }  ///< [main] the daemon refused the lead

 private:
  Lead() = default;
  std::unique_ptr<Daemon> daemon_;
  hapticd_lead_page* page_ = nullptr;
  bool refused_ = false;
};

}  // namespace hapticd::view
