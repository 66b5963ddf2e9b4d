// SPDX-License-Identifier: MIT
/// The connection to one arm of a running daemon, through the client library.
#pragma once
#include <atomic>
#include <memory>
#include <string>

#include "facts.hpp"
#include "hapticd/client.h"

namespace hapticd::hd {

/// Only one thread at a time may call open() and lead(). Other threads may wait, push and read at the same time.
class Link {
 public:
  /// [main] Connects to the daemon of $HAPTICD_NAME. @param name name of the arm; empty for the first arm @param why
  /// gets the reason of a failure and its fix @param number gets errno, or 0 @return nullptr if it cannot connect
  static std::shared_ptr<Link> open(const std::string& name, DeviceFacts& facts, std::string& why, int& number);
  Link(hapticd_client* client, int device) : client_(client), device_(device) {}
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  ~Link() { hapticd_close(client_); }

  /// [any] Does what hapticd_next_state does, for this arm.
  int next(uint64_t after, int timeout_ms, hapticd_state& state) const {
    return hapticd_next_state(client_, device_, after, timeout_ms, &state);
  }
  /// [any] Does what hapticd_listen does.
  void listen(unsigned microseconds) const { hapticd_listen(client_, microseconds); }
  /// [any] Reads the newest Jacobian of the arm. @return false if there is none
  bool jacobian(hapticd_jacobian& jacobian) const { return hapticd_read_jacobian(client_, device_, &jacobian) == 1; }
  /// [any] True if a daemon of this name runs. It may be another daemon than the one to which this object connected.
  bool runs() const { return hapticd_alive(client_) == 1; }
  /// [main] True if the daemon to which this object connected still runs.
  bool alive() const {
    return !lost && runs() && hapticd_ask(client_, R"({"do":"snapshot"})", nullptr, 0, nullptr) >= 0;
  }
  std::atomic<bool> lost{false};  ///< true if no tick has come for a long time

  /// [main] Begins a lead, so that push() has an effect. @return false, and the reason in `why`, if that is impossible
  bool lead(std::string& why);
  bool leads() const { return lead_ != nullptr; }
  void push(const hapticd_push& push) const {
    if (lead_ != nullptr) hapticd_lead_push(lead_, &push);
  }
  /// [any] Writes the newest temperatures of the windings [degC], for at most `most` joints. Unknown ones do not
  /// change.
  void temperatures(double* of_joint, size_t most) const;

 private:
  hapticd_client* client_;
  int device_;
  std::atomic<hapticd_lead*> lead_{nullptr};
};

}  // namespace hapticd::hd
