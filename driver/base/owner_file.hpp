// SPDX-License-Identifier: MIT
/// Keeps which file contains an owner's code, for the report of a crash. By the identity of the file, the next start
/// distinguishes a repaired plugin from the one that crashed. If memory was overwritten, plugins that do not ship with
/// hapticd are suspected first.
#pragma once
#include <cstddef>
#include <string>

#include "base/code_owner.hpp"

namespace hapticd {

/// The file that contains the code of an owner.
struct OwnersFile {
  std::string path;
  std::string identity;  ///< identity of the file when it was loaded, one line without tabs
  bool foreign = false;  ///< true if the file does not ship with hapticd
};

/// [main] Notes which file contains the code of an owner.
void setFileOfOwner(const Owner* owner, const OwnersFile& file);
/// [any] Returns the path of that owner's file; "" if none was given. Async-signal-safe.
const char* pathOf(const Owner* owner) noexcept;
/// [any] Returns the identity of that owner's file; "" if none was given. Async-signal-safe.
const char* fileOf(const Owner* owner) noexcept;
/// [any] Returns the owner of that number among the owners whose files do not ship with hapticd. Each module counts
/// once, and numbers begin at 0. Returns nullptr if there is no such number. Async-signal-safe.
const Owner* foreignOwner(size_t number) noexcept;

}  // namespace hapticd
