// SPDX-License-Identifier: MIT
/// The status page: the present state of a running daemon, for every program that may read the file. It is plain memory
/// of fixed layout, mapped from a file; readers map it read-only.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>

#include "hapticd/client.h"
#include "record/histogram.hpp"
#include "status/slot.hpp"

namespace hapticd::status {

constexpr uint64_t kPageMagic = 0x31544154535448;  ///< "HTSTAT1"
constexpr uint32_t kMaxArms = 8;
constexpr uint32_t kMaxModels = 96;  ///< models in places from this number on have no entry

/// Like record::Histogram, but for one writing and many reading threads.
class SharedHistogram {
 public:
  /// [rt] Counts one value.
  void add(double value) noexcept HSP_RT {
    bump(counts_[static_cast<size_t>(record::Histogram::bucketOf(value))]);
    bump(total_);
    if (value > max_.load(std::memory_order_relaxed)) max_.store(value, std::memory_order_relaxed);
  }
  /// [any] Returns the value below which a share q of all values lies; 0 if there are none.
  double quantile(double q) const noexcept {
    const auto total = static_cast<double>(total_.load(std::memory_order_relaxed));
    double seen = 0;
    for (int i = 0; i < record::Histogram::kBuckets && total > 0; ++i) {
      seen += static_cast<double>(counts_[static_cast<size_t>(i)].load(std::memory_order_relaxed));
      const double middle = 0.5 * (record::Histogram::edgeOf(i) + record::Histogram::edgeOf(i + 1));
      if (seen >= (q * total > 1 ? q * total : 1)) return middle < max() ? middle : max();
    }
    return 0;
  }
  double max() const noexcept { return max_.load(std::memory_order_relaxed); }
  /// [main] Removes all values. Not to be called while another thread adds.
  void clear() noexcept {
    for (auto& count : counts_) count.store(0, std::memory_order_relaxed);
    total_.store(0, std::memory_order_relaxed);
    max_.store(0, std::memory_order_relaxed);
  }

 private:
  static void bump(std::atomic<uint64_t>& count) noexcept HSP_RT {
    // There is one writer, so no atomic addition is needed.
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  std::array<std::atomic<uint64_t>, record::Histogram::kBuckets> counts_{};
  std::atomic<uint64_t> total_{0};
  std::atomic<double> max_{0};
};

/// Number and times of the last tick.
struct TickStatus {
  uint64_t tick = 0, overruns = 0, missed = 0;
  double t = 0;  ///< [s]
};

struct ArmStatus {
  double position[3] = {}, force[3] = {};  ///< [m] position of the tip; [N] force as sent; world frame
  uint64_t sequence = 0;                   ///< number of the newest sample
  uint32_t fault = 0, valid = 0;
};

struct ModelStatus {
  double depth = 0, force = 0, gain = 0;  ///< [m] depth, NaN if not traced; [N] force; factor of the force, 0 to 1
  uint64_t tick = 0;                      ///< number of the tick in which the model was last stepped
  int32_t status = 0;
  uint32_t iterations = 0;
  uint32_t trouble = 0;       ///< servo::ShapeFault: why the hand does not feel it
  int32_t failed_status = 0;  ///< the first status that step() returned and that the ABI does not allow; 0: none
  /// waits: 1 if the model was added or enabled, and a tip is or was inside; it is not felt until all tips have been
  /// outside for Core::kFreeFor.
  /// at_end: HAPTICD_LOWEST or HAPTICD_HIGHEST if its joint stands at that end of its range, else 0.
  uint32_t waits = 0, at_end = 0;
};

/// [any] Returns the name of an end of a joint's range, HAPTICD_LOWEST or HAPTICD_HIGHEST; "" for 0.
constexpr const char* nameOfEnd(uint32_t end) {
  if (end == 0) return "";
  return end == HAPTICD_LOWEST ? "lowest" : "highest";
}

/// Counts the ticks since a model was added, by its foot point. nearest: the point is proved to be the nearest. held: a
/// held contact keeps the point, although another point is nearer. degraded: the answer was degraded, so the point is
/// not proved to be the nearest.
struct ModelFeet {
  uint64_t nearest = 0, held = 0, degraded = 0;
};

/// A program that pushes on an arm.
struct Pusher {
  char program[56] = {};
  uint64_t pid = 0;  ///< 0 if the place is empty
};
struct PusherStatus {
  uint64_t answers = 0, in_time = 0, next_tick = 0, silences = 0;
  double force = 0, largest = 0;  ///< [N] its force now; its largest force so far
};
constexpr uint32_t kPushersOfArm = 8;

struct Name {
  char text[56] = {}, kind[56] = {};  ///< a model and its plugin, or a device and its module; "" if the place is empty
};

struct Page {
  std::atomic<uint64_t> magic{0};
  uint32_t bytes = 0, arms = 0, models = 0, pid = 0;
  double rate = 0;  ///< [Hz] rate of the servo, as asked for
  Slot<TickStatus> now;
  SharedHistogram lateness_us, compute_us;
  struct {
    Slot<Name> name;
    Slot<ArmStatus> now;
  } arm[kMaxArms];
  struct {
    Slot<Name> name;
    Slot<ModelStatus> now;
    SharedHistogram step_us;
  } model[kMaxModels];
  double answer_time = 0;  ///< [s] longest time in a tick for which the servo waits for programs' answers
  struct {
    Slot<Pusher> who;
    Slot<PusherStatus> now;
  } pusher[kMaxArms * kPushersOfArm];  ///< places of arm i begin at i * kPushersOfArm
  Slot<ModelFeet> feet[kMaxModels];    ///< counts of the foot points of each model, by its place
};

}  // namespace hapticd::status
