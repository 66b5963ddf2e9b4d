// SPDX-License-Identifier: MIT
/// Gives contact::ContactState access to a traced model, or to one of its parts, at the probe's position in this tick.
#pragma once
#include "kernels/trace/tracer.hpp"

namespace hapticd::trace {

inline constexpr int kMaxCrossings = 4;  ///< most sides that a foot crosses in one tick

class Tracer::Faces {
 public:
  /// @param part index of a part, or -1 for all parts together
  Faces(Tracer& tracer, int part, const Eigen::Vector3d& p, const TraceOptions& options) noexcept
      : tracer_(tracer), part_(part), p_(p), options_(options) {}

  contact::Followed follow(double side, Foot& foot) noexcept {
    const contact::Followed how = tracer_.follow(part_, side, p_, options_, foot);
    const bool came_out = how == contact::Followed::kOn && !(side * foot.depth > 0);
    if (came_out && options_.rule.sides == contact::Sides::kBoth &&
        isBehind(side)) {  // before the face, behind the next
      holdNearest();
      foot = nearest();
    }
    return how;
  }

  Foot nearest() noexcept {
    if (!known_) nearest_ = tracer_.nearestFoot(part_, p_, options_);
    known_ = true;
    return nearest_;
  }

  bool enter(const Eigen::Vector3d& from, contact::Sides sides, double& side) noexcept {
    // The nearest foot decides on the side of a closed shell, so it comes first, while evaluations are left.
    if (sides == contact::Sides::kBoth && tracer_.isClosedShell()) nearest();
    const Crossing first = tracer_.firstCrossing(part_, from, p_, side, options_);
    if (first.track < 0) return sides == contact::Sides::kBoth && cameThrough((p_ - from).norm(), side);
    side = first.side;
    tracer_.hold(part_, first.track);
    return true;
  }

  void holdNearest() noexcept { tracer_.hold(part_, tracer_.nearestTrack(part_)); }
  void release() noexcept { tracer_.hold(part_, -1); }

 private:
  /// True if the probe has come through a closed shell, because it was on the given side and is now on the other. Holds
  /// the nearest foot then. This needs no place where the path meets the shell, which firstCrossing() may not find near
  /// a pole, or with the evaluations that are left.
  bool cameThrough(double path_length, double side) noexcept {
    if (!isBehind(side) || !(contact::atLeast(nearest_) <= path_length)) return false;
    holdNearest();
    return true;
  }

  /// True if the probe is certainly behind a closed shell, seen from the given side. Of other models, another shell may
  /// be nearer, or the way round a free edge short.
  bool isBehind(double side) noexcept {
    return tracer_.isClosedShell() && nearest().status == FootStatus::kNearest && side * nearest_.behind > 0;
  }

  Tracer& tracer_;
  const int part_;
  const Eigen::Vector3d& p_;
  const TraceOptions& options_;
  Foot nearest_;  ///< nearest foot of this tick, if known_
  bool known_ = false;
};

}  // namespace hapticd::trace
