// SPDX-License-Identifier: MIT
/// Keeps the shapes of a tick within their budget of time: lowers the accuracy of the least important shape first, and
/// raises the accuracy again when there is time. No shape is ever left out.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "hapticd/abi.h"

namespace hapticd::servo {

/// How exactly a shape must answer. At level 0 it answers as its parameters say. No level uses a first-order method,
/// because far from a curved surface a first-order step loses the foot point, and the probe would seem to be inside.
struct Accuracy {
  static constexpr uint32_t kCoarsest = 3;
  /// At the coarsest level, a shape that no probe can reach soon answers only once in this many ticks.
  static constexpr uint32_t kTurns = 4;
  uint32_t max_iterations = 0, order = 0;  ///< see hsp_step

  static constexpr Accuracy of(uint32_t level) noexcept {
    constexpr Accuracy kLevels[kCoarsest + 1] = {{0, 0}, {4, 0}, {2, 0}, {1, 0}};
    return kLevels[level < kCoarsest ? level : kCoarsest];
  }
};

/// Cost and importance of one shape after the last tick.
struct Load {
  uint32_t model = 0, level = 0;
  uint64_t step_ns = 0;   ///< time of its step in the last tick
  uint64_t finer_ns = 0;  ///< time of a step before its accuracy was last lowered
  double importance = 0;  ///< [m] depth, negative outside; -infinity if it is not traced
  bool proven = false;    ///< true if step_ns is its own CPU time, without interruptions
};

/// Decides the levels of the next tick from the costs of the last one. Costs are an argument, so that tests can use
/// counted costs instead of measured ones.
class LoadShedding {
 public:
  static constexpr size_t kMostChanges = 4;  ///< most changes in one tick
  /// accuracy is raised only while all steps together take less than this share of the budget
  static constexpr double kComfort = 0.8;
  /// [ticks] after this many ticks of overload, the accuracy of a shape in contact may be lowered too
  static constexpr uint32_t kLasting = 20;
  /// [ticks] after this many ticks of low load in a row, an accuracy may be raised
  static constexpr uint32_t kPatience = 200;
  /// [ticks] longest time before an accuracy is raised; the time doubles after each raise that caused an overload
  static constexpr uint32_t kLongest = 20'000;

  struct Change {
    uint32_t model = 0, level = 0;
  };

  /// [rt] Returns the changes of accuracy for the next tick. @param loads costs of the shapes that were stepped
  /// @param budget_ns time for all shapes together
  std::span<const Change> findChanges(std::span<const Load> loads, uint64_t budget_ns) noexcept HSP_RT;

 private:
  void lower(std::span<const Load> loads, uint64_t spent, uint64_t budget_ns) noexcept HSP_RT;
  void raise(std::span<const Load> loads, uint64_t spent, uint64_t budget_ns) noexcept HSP_RT;
  bool mayLower(const Load& load) const noexcept HSP_RT;
  bool isProven(const Load& load) const noexcept HSP_RT;
  bool changed(uint32_t model) const noexcept HSP_RT;

  std::array<Change, kMostChanges> changes_{};
  size_t count_ = 0;
  uint32_t over_ = 0;                ///< weighted count of ticks of overload, see kWeight
  uint32_t calm_ = 0;                ///< ticks of low load in a row
  uint32_t since_raise_ = kLongest;  ///< ticks since accuracy was last raised
  uint32_t patience_ = kPatience;
};

}  // namespace hapticd::servo
