// SPDX-License-Identifier: MIT
/// Watches the steps of a plugin in the process that runs them. Counts their system calls, and records the position of
/// the probe for the case that the process ends.
#pragma once
#include <cstdint>
#include <string>

#include "conformance/guarded_memory.hpp"
#include "hapticd/shape.h"

namespace hapticd::conformance {

/// The function of a plugin that was called and has not returned.
enum class Inside : uint32_t { kNothing, kCreate, kSet, kActivate, kStep, kDestroy };

/// The present state of a child process. It lies in memory that the child shares with its parent, because a process
/// that crashes can report nothing itself.
struct LastStep {
  static constexpr uint32_t kMost = 8;
  double position[kMost][3];  ///< [m] positions of the probes of a step
  uint32_t count;             ///< number of these positions
  Inside inside;
  uint32_t probes;  ///< number of probes when a fault in guarded memory ended the child; 0 if none did
  Overrun overrun;
};

/// [main] Makes the shared memory, once and before the first child, and forgets the last step of the previous child.
void shareLastStep();

/// [main] Returns where the last child ended, and which block of memory it overran: ", in step() with the probe at X,
/// Y, Z m", or ", in activate()", or "" if it was not in the plugin.
std::string whereItEnded();

/// [main] True if the last child ended by a fault in guarded memory, so that the overrun block is known.
bool overran();

/// [main] True if the last child ended before there was an active shape.
bool endedBeforeSteps();

/// [main] From now on a fault in guarded memory reports to the parent which block was overrun. @param probes number of
/// probes of each step
void tellOverruns(uint32_t probes);

/// [main] From now on system calls of this thread within steps are counted. Returns false if this kernel or processor
/// cannot do this.
bool watchSystemCalls();

/// The steps that made a system call. A step that makes several is counted once.
struct SystemCalls {
  uint64_t steps = 0;  ///< number of steps that made a system call
  long number = 0;     ///< number (as in the kernel's table) of the last system call
  bool prints = false;
};
SystemCalls systemCalls();

/// Returns the name of a system call, such as "write", or "number 999" if its name is unknown here.
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
