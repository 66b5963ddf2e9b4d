// SPDX-License-Identifier: MIT
/// Installs handlers for the signals that end the process.
#pragma once
#include <signal.h>

namespace hapticd::os {

/// Installs a handler for SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTRAP and SIGSYS, and for every other
/// signal that ends a process and that nobody handles or ignores, such as SIGUSR1, SIGUSR2, timers, SIGIO and real-time
/// signals. nullptr restores the system's default.
void onFatalSignals(void (*handler)(int, siginfo_t*, void*));

/// Replaces the present handlers of SIGINT, SIGTERM, SIGQUIT and SIGHUP by this handler. A signal that is ignored stays
/// ignored. nullptr restores the former handlers, unless the program has installed another one meanwhile.
void onStopSignals(void (*handler)(int, siginfo_t*, void*));
/// Returns the handler of a signal before onStopSignals(); nullptr if it was the system's default. Async-signal-safe.
void (*formerStop(int signal) noexcept)(int);

}  // namespace hapticd::os
