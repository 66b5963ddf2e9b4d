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
    const bool on = how == contact::Followed::kOn && side * foot.depth > 0;
    if (on || options_.rule.sides != contact::Sides::kBoth || !isBehindNext(side)) return how;
    holdNearest();
    foot = nearest();
    return contact::Followed::kOn;
  }

  Foot nearest() noexcept {
    if (!known_) nearest_ = tracer_.nearestFoot(part_, p_, options_);
    known_ = true;
    Foot foot = nearest_;
    if (tracer_.undecided_ && foot.status == FootStatus::kNearest) foot.status = FootStatus::kDegraded;
    return foot;
  }

  bool enter(const contact::PathStart& from, contact::Sides sides, double& side) noexcept {
    const Eigen::Vector3d way = p_ - from.point;
    const int closed = sides == contact::Sides::kBoth ? shellAround(way.norm()) : -1;
    const Crossing first = tracer_.firstCrossing(part_, {from, side, closed}, p_, options_);
    if (first.track < 0) return closed >= 0 && cameThrough(way, side);
    side = first.side;
    tracer_.hold(part_, first.track);
    return true;
  }

  void holdNearest() noexcept { tracer_.hold(part_, tracer_.nearestTrack(part_)); }
  void release() noexcept { tracer_.hold(part_, -1); }

  int granted() const noexcept { return granted_; }  ///< evaluations that this tick got on top of its budget

 private:
  void grant(int evaluations) noexcept {
    tracer_.budget_ += evaluations;
    granted_ += evaluations;
  }

  /// Returns the shell of the nearest foot, if it was that in the last tick too, and does not end within `reach` [m] of
  /// p: no straight path of that length to p leads round it. Returns -1 if there is no such shell.
  int shellAround(double reach) noexcept {
    nearest();  // it decides on the side, so it comes first, while evaluations are left
    const bool known = shell() >= 0 && shell() == tracer_.last_shell_;
    return known && tracer_.model_.freeSides().areBeyond(shell(), p_, reach) ? shell() : -1;
  }

  int shell() const noexcept { return tracer_.shellOf(tracer_.nearestTrack(part_)); }

  /// True if the probe has come through a shell that does not end near by, because it was on the given side and is now
  /// on the other. Holds the nearest foot then. This needs no place where the path meets the shell, which
  /// firstCrossing() may not find near a pole or a crease, or with the evaluations that are left.
  bool cameThrough(const Eigen::Vector3d& way, double side) noexcept {
    if (!isBehind(side) || !(contact::atLeast(nearest_) <= way.norm())) return false;
    if (!tracer_.model_.closed(shell())) {
      // Another layer of a rolled sheet may be nearer now. The path began on the same side of it.
      grant(TraceOptions::kForSide);
      if (tracer_.isOnSameSide(tracer_.nearestTrack(part_), p_ - way)) return false;
    }
    tracer_.undecided_ = false;
    holdNearest();
    return true;
  }

  /// True if the probe is certainly behind its nearest foot, seen from the given side. Beside a free edge it is neither
  /// before nor behind.
  bool isBehind(double side) noexcept {
    nearest();
    return nearest_.status == FootStatus::kNearest && !(nearest_.aside > 0) && side * nearest_.behind > 0;
  }

  /// The same for a probe that has come out in front of the held face: it may be behind the next one.
  bool isBehindNext(double side) noexcept {
    if (!isBehind(side)) return false;
    const bool same = shell() == tracer_.shellOf(tracer_.contactOf(part_).held);
    return same && (tracer_.model_.closed(shell()) || tracer_.isNextToHeld(part_));
  }

  Tracer& tracer_;
  const int part_;
  const Eigen::Vector3d& p_;
  const TraceOptions& options_;
  Foot nearest_;  ///< nearest foot of this tick, if known_
  bool known_ = false;
  int granted_ = 0;
};

}  // namespace hapticd::trace
