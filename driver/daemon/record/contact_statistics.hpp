// SPDX-License-Identifier: MIT
/// Statistics of the depth, force and cost of one model over a run, computed in the servo thread without allocation.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "hapticd/abi.h"
#include "record/histogram.hpp"

namespace hapticd::record {

/// Ticks in which a model pushed although its answer reported no contact.
struct Pushes {
  uint64_t ticks = 0;
  double max_force = 0;  ///< [N] largest force in these ticks
  void add(double force_n) noexcept HSP_RT {
    ++ticks;
    max_force = std::max(max_force, force_n);
  }
};

class ContactStatistics {
 public:
  static constexpr double kBuzzWindow = 0.02;  ///< [s] changes of depth within this time are felt as buzz

  /// [rt] Adds a tick. @param depth_m and force_n count only in contact, and if they are finite
  /// @param step_ns duration of the step; 0 if it was not measured
  void add(bool contact, double depth_m, double force_n, double dt, uint64_t step_ns) noexcept HSP_RT {
    if (step_ns > 0) step_us_.add(static_cast<double>(step_ns) * 1e-3);
    if (!contact || !std::isfinite(depth_m) || !std::isfinite(force_n)) {
      closeWindow();
      return;
    }
    ++ticks_;
    const double delta = depth_m - mean_;  // Welford's recurrence, which loses no digits over long runs
    mean_ += delta / static_cast<double>(ticks_);
    spread_ += delta * (depth_m - mean_);
    max_depth_ = std::max(max_depth_, depth_m);
    force_sum_ += force_n;
    max_force_ = std::max(max_force_, force_n);
    addToWindow(depth_m, dt);
  }

  /// [rt] Adds a tick of contact in which the model gave no force: it was disabled, or waited until the tip had left
  /// it.
  void addUnfelt() noexcept HSP_RT { ++unfelt_; }
  /// [rt] Adds a tick in which the model pushed although it traced no surface, so that no contact can be reported.
  void addUntraced(double force_n) noexcept HSP_RT { untraced_.add(force_n); }
  /// [rt] Adds a tick in which the model pushed with a depth_m of 0. Probably its shape never sets depth_m.
  void addDepthless(double force_n) noexcept HSP_RT { depthless_.add(force_n); }
  /// [rt] Adds a tick in which the model pushed with a depth_m below 0. Either it pushes from outside, as a magnet
  /// does, or its depth_m has the wrong sign.
  void addOutside(double force_n) noexcept HSP_RT { outside_.add(force_n); }

  /// [rt] Adds a tick of contact in which the force pulled the probe deeper in.
  void addPull(double force_n) noexcept HSP_RT { pulls_.add(force_n); }

  /// [rt] Adds a tick that has a foot point. @param held true if a held contact keeps this point, although another
  /// point is nearer @param degraded true if the answer was degraded, so that the point is not proved to be the
  /// nearest; `held` is then ignored
  void addFoot(bool held, bool degraded) noexcept HSP_RT {
    ++(degraded ? degraded_feet_ : held ? held_feet_ : nearest_feet_);
  }

  uint64_t contactTicks() const noexcept { return ticks_; }
  uint64_t unfeltTicks() const noexcept { return unfelt_; }        ///< ticks of contact without a force
  const Pushes& untraced() const noexcept { return untraced_; }    ///< pushes without a surface
  const Pushes& depthless() const noexcept { return depthless_; }  ///< pushes at a depth of exactly 0
  const Pushes& outside() const noexcept { return outside_; }      ///< pushes at a depth below 0
  const Pushes& pulls() const noexcept { return pulls_; }          ///< pulls into the surface, in contact
  /// ticks with a foot point that is proved to be the nearest
  uint64_t nearestFeet() const noexcept { return nearest_feet_; }
  uint64_t heldFeet() const noexcept { return held_feet_; }  ///< ticks of a held contact; another point is nearer
  /// ticks with a degraded answer, so that the foot point is not proved to be the nearest
  uint64_t degradedFeet() const noexcept { return degraded_feet_; }
  double meanDepth() const noexcept { return mean_; }  ///< [m]
  double stdDepth() const noexcept { return ticks_ > 1 ? std::sqrt(spread_ / static_cast<double>(ticks_ - 1)) : 0; }
  double maxDepth() const noexcept { return max_depth_; }
  double meanForce() const noexcept { return ticks_ > 0 ? force_sum_ / static_cast<double>(ticks_) : 0; }  ///< [N]
  double maxForce() const noexcept { return max_force_; }
  /// Returns the root mean square [m] of the depth about its mean in windows of 20 ms.
  double buzz() const noexcept { return buzz_ticks_ > 0 ? std::sqrt(buzz_sum_ / static_cast<double>(buzz_ticks_)) : 0; }
  const Histogram& stepUs() const noexcept { return step_us_; }

 private:
  void addToWindow(double depth, double dt) noexcept HSP_RT {
    ++window_ticks_;
    const double delta = depth - window_mean_;
    window_mean_ += delta / window_ticks_;
    window_spread_ += delta * (depth - window_mean_);
    window_time_ += dt;
    if (window_time_ >= kBuzzWindow) closeWindow();
  }
  void closeWindow() noexcept HSP_RT {
    if (window_time_ >= kBuzzWindow) {  // a window that ended early would count the impact itself as buzz
      buzz_sum_ += window_spread_;
      buzz_ticks_ += static_cast<uint64_t>(window_ticks_);
    }
    window_ticks_ = window_mean_ = window_spread_ = window_time_ = 0;
  }

  uint64_t ticks_ = 0, unfelt_ = 0, buzz_ticks_ = 0, nearest_feet_ = 0, held_feet_ = 0, degraded_feet_ = 0;
  double mean_ = 0, spread_ = 0, max_depth_ = 0, force_sum_ = 0, max_force_ = 0, buzz_sum_ = 0;
  double window_ticks_ = 0, window_mean_ = 0, window_spread_ = 0, window_time_ = 0;
  Pushes untraced_, depthless_, outside_, pulls_;
  Histogram step_us_;
};

}  // namespace hapticd::record
