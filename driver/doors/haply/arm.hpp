// SPDX-License-Identifier: MIT
/// One arm of a daemon, for one program. A thread answers every tick with the newest force of the program, so that the
/// program may send forces at a lower rate.
#pragma once
#include <atomic>
#include <mutex>
#include <string>

#include "base/os.hpp"
#include "base/result.hpp"
#include "hapticd/client.h"

namespace hapticd::haply {

class Arm {
 public:
  static constexpr uint64_t kHoldsNs = 100'000'000;  ///< [ns] a force ends this long after the program's last message

  Arm(hapticd_client* client, int device, std::string name)
      : client_(client), device_(device), name_(std::move(name)) {}
  ~Arm();
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;

  const std::string& name() const { return name_; }
  /// [main] Reads the newest state. Returns false if the daemon sends no more states.
  bool readState(hapticd_state& state);
  /// [main] Sets the force [N, world frame] that is applied from now on. The first call begins a lead of the force.
  Result<void> push(const double force[3]);
  /// [main] Returns the force that is applied now [N].
  void readForce(double force[3]) const;

 private:
  void run();
  hapticd_client* client_;
  int device_;
  std::string name_;
  hapticd_lead* lead_ = nullptr;
  os::Thread thread_;
  std::atomic<bool> end_{false};
  mutable std::mutex lock_;
  double force_[3] = {};
  uint64_t heard_ns_ = 0;
};

}  // namespace hapticd::haply
