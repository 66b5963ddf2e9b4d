// SPDX-License-Identifier: MIT
/// _exit() and _Exit(), which end a process without a word: a module that calls one is heard first.
#pragma once

namespace hapticd::watch {

/// [main] What _exit() does first, whoever calls it; nullptr: nothing. `heard` must be async-signal-safe.
void onPlainExit(void (*heard)());

/// [any] Ends the process without calling that function. Async-signal-safe.
[[noreturn]] void endProcess(int code) noexcept;

}  // namespace hapticd::watch
