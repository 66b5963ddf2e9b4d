// SPDX-License-Identifier: MIT
/// Finds out whose code caused a fatal signal. The functions are [any] and async-signal-safe, except prepareBlame().
#pragma once
#include <csignal>

#include "base/code_owner.hpp"
#include "watch/crash_steps.hpp"

namespace hapticd::watch {

struct Blame {
  const Owner* culprit;  ///< nullptr blames nobody
  Suspicion suspicion;
};

/// [main] Finds the place where the C library stores the message of an abort. Call it before the other functions.
void prepareBlame() noexcept;

/// True if another process sent the signal.
bool sentByOther(const siginfo_t& info) noexcept;

/// Returns the owner of the code that raised a signal; nullptr if the owner is unknown. The owner counts as unknown if
/// another process sent the signal, or if the signal was sent to the whole process, because a wrong name would be worse
/// than none.
const Owner* culpritOf(int signal, const siginfo_t& info, const void* context) noexcept;

/// Returns whose code is to blame for a crash: the owner that culpritOf() returns. But if the allocator found damaged
/// memory, and code that does not ship with hapticd is loaded, shipped code is not blamed, because it may only have
/// freed this memory.
Blame blameFor(int signal, const siginfo_t& info, const void* context) noexcept;

}  // namespace hapticd::watch
