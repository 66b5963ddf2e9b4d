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
    if (came_out && options_.rule.sides == contact::Sides::kBoth && isBehindNext(side)) {
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
    const bool closed = sides == contact::Sides::kBoth && tracer_.isClosedAround(p_, (p_ - from).norm());
    if (closed) nearest();  // it decides on the side, so it comes first, while evaluations are left
    const Crossing first = tracer_.firstCrossing(part_, from, p_, side, options_);
    if (first.track < 0) return closed && cameThrough(p_ - from, side);
    side = first.side;
    tracer_.hold(part_, first.track);
    return true;
  }

  void holdNearest() noexcept { tracer_.hold(part_, tracer_.nearestTrack(part_)); }
  void release() noexcept { tracer_.hold(part_, -1); }

 private:
  /// True if the probe has come through a shell without an end near by, because it was on the given side and is now on
  /// the other. Holds the nearest foot then. This needs no place where the path meets the shell, which firstCrossing()
  /// may not find near a pole or a crease, or with the evaluations that are left.
  bool cameThrough(const Eigen::Vector3d& way, double side) noexcept {
    if (!isBehind(side) || !(contact::atLeast(nearest_) <= way.norm())) return false;
    // Between the layers of a rolled sheet, the other layer may be nearer now. The probe comes to it from behind.
    if (!tracer_.isClosedShell() && !(way.dot(p_ - nearest_.point) > 0)) return false;
    holdNearest();
    return true;
  }

  /// True if the probe is certainly behind its nearest foot, seen from the given side. Beside a free edge it is neither
  /// before nor behind.
  bool isBehind(double side) noexcept {
    return nearest().status == FootStatus::kNearest && !(nearest_.aside > 0) && side * nearest_.behind > 0;
  }

  /// The same for a probe that has come out in front of the held face: it may be behind the next one.
  bool isBehindNext(double side) noexcept {
    return isBehind(side) && (tracer_.isClosedShell() || tracer_.isNextToHeld(part_));
  }

  Tracer& tracer_;
  const int part_;
  const Eigen::Vector3d& p_;
  const TraceOptions& options_;
  Foot nearest_;  ///< nearest foot of this tick, if known_
  bool known_ = false;
};

}  // namespace hapticd::trace
