// SPDX-License-Identifier: MIT
/// Runs the proximity search in step with virtual time, so that every virtual run gives the same result: at the start,
/// every 5 ms, and in the tick after a jump or a lost track.
#pragma once
#include <functional>

#include "servo/core/core.hpp"

namespace hapticd::servo {

class Lockstep {
 public:
  /// [main] @param core asks for searches by needsSearch(); must outlive this object @param search runs one global
  /// search
  Lockstep(const Core& core, std::function<void()> search) : core_(core), search_(std::move(search)) {}

  /// Runs a search if it is due. Called before a tick at time t [s], after the probes were published. Not real-time:
  /// the search allocates.
  void before(double t);

 private:
  const Core& core_;
  std::function<void()> search_;
  bool started_ = false;
  double last_ = 0;
};

}  // namespace hapticd::servo
