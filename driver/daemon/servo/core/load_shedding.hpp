// SPDX-License-Identifier: MIT
/// Keeps the shapes of a tick within their budget: lowers the accuracy of the least important one first, and gives it
/// back when there is room again. No shape is ever left out.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "hapticd/abi.h"

namespace hapticd::servo {

/// How exactly a shape must answer. 0: as its parameters say. The method is never of first order: far from a curved
/// surface that step leaves the foot, and the probe seems to be inside.
struct Accuracy {
  static constexpr uint32_t kCoarsest = 3;
  static constexpr uint32_t kTurns = 4;    ///< a coarsest shape out of reach answers in one of so many ticks
  uint32_t max_iterations = 0, order = 0;  ///< hsp_step's

  static constexpr Accuracy of(uint32_t level) noexcept {
    constexpr Accuracy kLevels[kCoarsest + 1] = {{0, 0}, {4, 0}, {2, 0}, {1, 0}};
    return kLevels[level < kCoarsest ? level : kCoarsest];
  }
};

/// One shape, as the last tick left it.
struct Load {
  uint32_t model = 0, level = 0;
  uint64_t step_ns = 0;   ///< of the last tick
  uint64_t finer_ns = 0;  ///< its cost one level finer, when it was last there
  double importance = 0;  ///< [m] depth in contact, minus the distance otherwise; -infinity: not traced
  bool proven = false;    ///< it took that time itself, without an interruption
};

/// Decides for the next tick from the cost of the last one. Costs are an argument: measured in a run, counted in
/// tests.
class LoadShedding {
 public:
  static constexpr size_t kMostChanges = 4;     ///< in a tick
  static constexpr double kComfort = 0.8;       ///< share of the budget up to which accuracy is given back
  static constexpr uint32_t kLasting = 20;      ///< [ticks] of overload in a row before a shape in contact is lowered
  static constexpr uint32_t kPatience = 200;    ///< [ticks] of low load before accuracy is given back
  static constexpr uint32_t kLongest = 20'000;  ///< [ticks] the same after attempts that failed

  struct Change {
    uint32_t model = 0, level = 0;
  };

  /// [rt] @param loads of the shapes that were stepped @param budget_ns of all of them
  std::span<const Change> judge(std::span<const Load> loads, uint64_t budget_ns) noexcept HSP_RT;

 private:
  void lower(std::span<const Load> loads, uint64_t spent, uint64_t budget_ns) noexcept HSP_RT;
  void raise(std::span<const Load> loads, uint64_t spent, uint64_t budget_ns) noexcept HSP_RT;
  bool mayLower(const Load& load) const noexcept HSP_RT;
  bool isProven(const Load& load) const noexcept HSP_RT;
  bool changed(uint32_t model) const noexcept HSP_RT;

  std::array<Change, kMostChanges> changes_{};
  size_t count_ = 0;
  uint32_t over_ = 0;                ///< ticks of overload in a row
  uint32_t calm_ = 0;                ///< ticks of low load in a row
  uint32_t since_raise_ = kLongest;  ///< ticks
  uint32_t patience_ = kPatience;
};

}  // namespace hapticd::servo
