// SPDX-License-Identifier: MIT
/// Runs the simulation side in step with simulated time, so that virtual runs and traces are the same every time: a
/// search at the start, every 5 ms, and in the tick after a jump or a lost track.
#pragma once
#include <functional>

#include "servo/core/core.hpp"

namespace hapticd::servo {

class Lockstep {
 public:
  /// [main] @param core says when it wants a search; outlives this  @param search one global search
  Lockstep(const Core& core, std::function<void()> search) : core_(core), search_(std::move(search)) {}

  /// Called before a tick at time t [s], after the probes were published. Not for real time: the search allocates.
  void before(double t);

 private:
  const Core& core_;
  std::function<void()> search_;
  bool started_ = false;
  double last_ = 0;
};

}  // namespace hapticd::servo
