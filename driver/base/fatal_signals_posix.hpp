// SPDX-License-Identifier: MIT
/// Signals that end the process.
#pragma once
#include <signal.h>

namespace hapticd::os {

/// Installs a handler for SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTRAP and SIGSYS, and for every other
/// signal that ends a process and that nobody handles or ignores: SIGUSR1 and 2, timers, SIGIO, real-time signals and
/// their kind. nullptr: the system's own again.
void onFatalSignals(void (*handler)(int, siginfo_t*, void*));

}  // namespace hapticd::os
