// SPDX-License-Identifier: MIT
/// What happens if a fault ends the process: the motors are switched off, the plugin is noted so that the next start
/// leaves it out, the black box is saved, and the message is printed. Every function is [any] and async-signal-safe.
#pragma once
#include "watch/line.hpp"
#include "watch/watch_target.hpp"

namespace hapticd::watch {

/// How likely it is that code which does not ship with hapticd caused a crash in the daemon's own code.
enum class Suspicion {
  kNone,   ///< not likely: the signal came from outside, or the culprit is known
  kCrash,  ///< possible
  kTorn    ///< most likely: memory was overwritten or freed twice
};

struct Cause {
  const char* reason;    ///< such as "Segmentation fault"
  const Owner* culprit;  ///< owner of the code that did it; nullptr blames nobody
  Suspicion suspicion;
};

/// Ends the process with exit code 1, in several steps. If a step itself crashes, the next step follows.
/// @param servo the watched servo; nullptr ends the process without any step
/// @param dir folder for the black box and the quarantine file; "": neither is written. The text must stay valid
[[noreturn]] void endInSteps(WatchTarget* servo, const char* dir, const Cause& cause) noexcept;

/// Switches the motors off, and waits a moment until the command has been sent. A thread of the module may still have
/// to send it, and would end with the process.
void cutAndAwait(WatchTarget& servo) noexcept;

/// Adds the name of an owner, such as "plugin 'torus' of model 'ring'".
Line& addOwner(Line& line, const Owner& owner) noexcept;

/// Adds the function that the owner's code was called for, such as " in its activate()". If `name` is nullptr, it adds
/// " in a step" for a shape.
Line& addCall(Line& line, const Owner& owner, const char* name) noexcept;

}  // namespace hapticd::watch
