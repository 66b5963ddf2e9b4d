// SPDX-License-Identifier: MIT
/// Signals that end the process.
#pragma once
#include <signal.h>

namespace hapticd::os {

/// Installs a handler for SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTRAP and SIGSYS, and for every other
/// signal that ends a process and that nobody handles or ignores: SIGUSR1 and 2, timers, SIGIO, real-time signals and
/// their kind. nullptr restores the system's own.
void onFatalSignals(void (*handler)(int, siginfo_t*, void*));

/// Installs a handler for SIGINT, SIGTERM, SIGQUIT and SIGHUP in front of the present ones, except where the signal is
/// ignored. nullptr restores those, unless another took its place meanwhile.
void onStopSignals(void (*handler)(int, siginfo_t*, void*));
/// The handler that was there before; nullptr: the system's own. Async-signal-safe.
void (*formerStop(int signal) noexcept)(int);

}  // namespace hapticd::os
