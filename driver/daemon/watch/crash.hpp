// SPDX-License-Identifier: MIT
/// The end of a daemon whose plugin crashed or never came back: motors off first, then the black box with the plugin's
/// name, then a note that keeps the plugin out of the next start, then the exit.
#pragma once
#include <filesystem>
#include <string>

#include "watch/watched.hpp"

namespace hapticd::watch {

/// [main] Handles SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGXCPU (a servo thread that never sleeps) until `forget`.
/// @param dir for the black box and the quarantine file; empty: neither is written
void guardAgainstCrash(Watched& servo, const std::filesystem::path& dir);

/// [main] The signals do what they did before; the servo may be destroyed.
void forgetCrash();

/// [any] What the handler does, async-signal-safe, ended by _exit(1). @param reason such as "Segmentation fault"
[[noreturn]] void dieOf(const char* reason) noexcept;

}  // namespace hapticd::watch
