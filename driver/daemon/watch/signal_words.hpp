// SPDX-License-Identifier: MIT
/// What signals are called in messages.
#pragma once
#include "watch/line.hpp"

namespace hapticd::watch {

/// [any] What went wrong, for a signal that a fault of the code raises; nullptr for other signals.
const char* wordsOfCrash(int signal) noexcept;

/// [any] The same for every signal.
Line words(int signal) noexcept;

}  // namespace hapticd::watch
