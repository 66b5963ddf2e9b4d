// SPDX-License-Identifier: MIT
/// Shows a parent process which function of a device module its child is calling. After a crash of the child, this is
/// the only way to find out which function crashed.
#pragma once
#include "host/child.hpp"

namespace hapticd::host {

/// [main] From now on, the calls of device modules during the set-up are noted in `trail`; nullptr ends that. Only a
/// child process may call it.
void followCalls(ChildProgress* trail) noexcept;

/// [main] Notes that a module's function is about to be called. @param name name of the function, in static storage
void noteCall(const char* name) noexcept;

}  // namespace hapticd::host
