// SPDX-License-Identifier: MIT
/// Watches the steps of a plugin from the process that they run in: where the probe was when it ended, system calls.
#pragma once
#include <cstdint>
#include <string>

#include "conformance/guarded_memory.hpp"
#include "hapticd/shape.h"

namespace hapticd::conformance {

/// The function of a plugin that was called and has not returned.
enum class Inside : uint32_t { kNothing, kCreate, kSet, kActivate, kStep, kDestroy };

/// Where a child is, in memory that it shares with its parent, because a crash leaves no other trace.
struct LastStep {
  static constexpr uint32_t kMost = 8;
  double position[kMost][3];  ///< [m] of the probes of a step
  uint32_t count;             ///< of them
  Inside inside;
  uint32_t probes;  ///< 0, or how many probes there were when a fault ended it in guarded memory
  Overrun overrun;
};

/// [main] Makes the shared memory, once and before the first child, and forgets the last step of the previous child.
void shareLastStep();

/// [main] Where the last child was: ", in step() with the probe at X, Y, Z m", ", in activate()", or "" if it was not
/// in the plugin; and what it overran.
std::string whereItEnded();

/// [main] True if the last child ended by a fault in guarded memory, so that the overrun block is known.
bool overran();

/// [main] True if the last child ended before there was an active shape.
bool endedBeforeSteps();

/// [main] From now on a fault in guarded memory tells the parent which block was overrun. @param probes of each step
void tellOverruns(uint32_t probes);

/// [main] From now on system calls of this thread within steps are counted. False if this kernel or processor cannot do
/// it.
bool watchSystemCalls();

/// The first system call of each step; a step that makes several is counted once.
struct SystemCalls {
  uint64_t steps = 0;  ///< that made one
  long number = 0;     ///< of the last one
  bool prints = false;
};
SystemCalls systemCalls();

/// "write" for its number, "number 999" for one without a name here.
std::string systemCallName(long number);

/// Surrounds a call of the plugin other than step().
class CallWatch {
 public:
  explicit CallWatch(Inside inside) noexcept;
  ~CallWatch();
  CallWatch(const CallWatch&) = delete;
  CallWatch& operator=(const CallWatch&) = delete;
};

/// Surrounds one call of step().
class StepWatch {
 public:
  explicit StepWatch(const hsp_step& step) noexcept;
  ~StepWatch();
  StepWatch(const StepWatch&) = delete;
  StepWatch& operator=(const StepWatch&) = delete;
};

}  // namespace hapticd::conformance
