// SPDX-License-Identifier: MIT
/// Intercepts _exit() and _Exit(), which end a process without calling any handler, so that a module that calls them is
/// noticed.
#pragma once

namespace hapticd::watch {

/// [main] Sets a function that is called first when any code calls _exit(); nullptr for none. `heard` is that function,
/// and must be async-signal-safe.
void onPlainExit(void (*heard)());

/// [any] Ends the process without calling that function. Async-signal-safe.
[[noreturn]] void endProcess(int code) noexcept;

}  // namespace hapticd::watch
