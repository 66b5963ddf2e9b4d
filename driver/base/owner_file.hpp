// SPDX-License-Identifier: MIT
/// Which file an owner's code came from, for those who end the process: by it a repaired plugin is another one, and one
/// that does not ship with the daemon is looked at first where memory was overwritten.
#pragma once
#include <cstddef>
#include <string>

#include "base/blame.hpp"

namespace hapticd {

/// [main] @param identity of the file as it was loaded, one line without tabs  @param foreign it does not ship with us
void keepFile(const Owner* owner, const std::string& identity, bool foreign);
/// [any] The file of that owner; "" if none was given. Async-signal-safe.
const char* fileOf(const Owner* owner) noexcept;
/// [any] The owners whose files do not ship with hapticd, each module once. The first is number 0; nullptr: there are
/// no more. Async-signal-safe.
const Owner* foreignOwner(size_t number) noexcept;

}  // namespace hapticd
