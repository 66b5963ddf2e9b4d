// SPDX-License-Identifier: MIT
/// Names of signals in messages.
#pragma once
#include "watch/line.hpp"

namespace hapticd::watch {

/// [any] Returns what went wrong, for a signal that faulty code raises; nullptr for other signals.
const char* crashName(int signal) noexcept;

/// [any] Returns a text that names the signal in messages, for any signal.
Line signalName(int signal) noexcept;

}  // namespace hapticd::watch
