// SPDX-License-Identifier: MIT
/// What is done and told where a fault ends the process: motors off, the note that keeps a plugin out of the next
/// start, the black box, then the words. Every function is [any] and async-signal-safe.
#pragma once
#include "watch/line.hpp"
#include "watch/watched.hpp"

namespace hapticd::watch {

/// What a crash in the daemon's own code says of the code that does not ship with it.
enum class Suspicion {
  kNone,   ///< nothing: a signal from outside, or a culprit that is known
  kCrash,  ///< it may have done it
  kTorn    ///< memory was overwritten or freed twice, and whoever did it has gone: most likely it did
};

struct Cause {
  const char* reason;    ///< such as "Segmentation fault"
  const Owner* culprit;  ///< whose code did it; nullptr: nobody is blamed
  Suspicion suspicion;
};

/// Ends the process with exit code 1. Whatever crashes on the way is passed over: the next part follows.
/// @param servo nullptr: nothing is watched, so that nothing is done or told
/// @param dir for the black box and the quarantine file; "": neither is written. Stays until the end of the process
[[noreturn]] void die(Watched* servo, const char* dir, const Cause& cause) noexcept;

/// Motors free; what an I/O thread has still to send goes with the process, so that it gets a moment.
void cutAndAwait(Watched& servo) noexcept;

/// "plugin 'torus' of model 'ring'"
Line& addOwner(Line& line, const Owner& owner) noexcept;

/// " in its activate()", " in a step": what a module without a name for it was called for.
Line& addCall(Line& line, const Owner& owner, const char* name) noexcept;

}  // namespace hapticd::watch
