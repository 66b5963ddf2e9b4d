// SPDX-License-Identifier: MIT
/// Watches the steps of a plugin from the process that they run in: where the probe was when it ended, system calls.
#pragma once
#include <cstdint>
#include <string>

#include "hapticd/shape.h"

namespace hapticd::conformance {

/// The step that a child is in, in memory that it shares with its parent: a crash leaves no other trace of it.
struct LastStep {
  double position[3];  ///< [m] of the first probe
  uint32_t inside;     ///< 1: step() was called and has not returned
};

/// [main] Makes the shared memory, once and before the first child, and forgets the last step of the child before.
void shareLastStep();

/// [main] Where the last child was: ", in step() with the probe at X, Y, Z m", or "" when it was not in a step.
std::string whereItEnded();

/// [main] From now on system calls of this thread within steps are counted. False: this kernel, or this kind of
/// processor, does not tell.
bool watchSystemCalls();

/// The first system call of each step; a step that makes several counts once.
struct SystemCalls {
  uint64_t steps = 0;  ///< that made one
  long number = 0;     ///< of the last one
  bool prints = false;
};
SystemCalls systemCalls();

/// "write" for its number, "number 999" for one without a name here.
std::string systemCallName(long number);

/// Stands around one call of step().
class StepWatch {
 public:
  explicit StepWatch(const hsp_probe& probe) noexcept;
  ~StepWatch();
  StepWatch(const StepWatch&) = delete;
  StepWatch& operator=(const StepWatch&) = delete;
};

}  // namespace hapticd::conformance
