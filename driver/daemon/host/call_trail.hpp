// SPDX-License-Identifier: MIT
/// Which call of a device module a child process is in, told to its parent: a crash leaves no other trace of it.
#pragma once
#include "host/child.hpp"

namespace hapticd::host {

/// [main] From now on calls of device modules at set-up are noted in `trail`; nullptr ends that. Used in a child only.
void followCalls(Trail* trail) noexcept;

/// [main] A module's function is about to be called. @param name in static storage
void tellCall(const char* name) noexcept;

}  // namespace hapticd::host
