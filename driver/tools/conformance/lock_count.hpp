// SPDX-License-Identifier: MIT
/// Counts the locks that a loaded library takes, by putting counting functions in the place of its own calls.
#pragma once
#include <cstdint>
#include <string>

namespace hapticd::conformance {

/// [main] From now on, calls of lock functions by that library are counted. False if it imports none.
bool countLocksOf(const std::string& file);

/// [any] The count so far, in all threads.
uint64_t locksCounted();

}  // namespace hapticd::conformance
