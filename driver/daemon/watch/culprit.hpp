// SPDX-License-Identifier: MIT
/// Whose code a fatal signal came from. Functions are [any] and async-signal-safe, except prepareBlame().
#pragma once
#include <csignal>

#include "base/code_owner.hpp"
#include "watch/crash_steps.hpp"

namespace hapticd::watch {

struct Blame {
  const Owner* culprit;  ///< nullptr blames nobody
  Suspicion suspicion;
};

/// [main] Call it before the others: looks up where the C library keeps its last message.
void prepareBlame() noexcept;

/// True if another process sent the signal.
bool sentByOther(const siginfo_t& info) noexcept;

/// Returns the owner of the code that raised a signal; nullptr if the owner is unknown. The owner counts as unknown if
/// another process sent the signal, or if it was sent to the whole process: no name is better than a wrong one.
const Owner* culpritOf(int signal, const siginfo_t& info, const void* context) noexcept;

/// Returns whom a crash blames: as culpritOf(), but code that ships with hapticd is not blamed if the allocator found
/// damaged memory, because such code may only have freed it.
Blame blameFor(int signal, const siginfo_t& info, const void* context) noexcept;

}  // namespace hapticd::watch
