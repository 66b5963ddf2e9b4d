// SPDX-License-Identifier: MIT
/// Counts the locks that a loaded library takes. The calls of lock functions in the library are redirected to functions
/// that count and then lock.
#pragma once
#include <cstdint>
#include <string>

namespace hapticd::conformance {

/// [main] From now on, calls of lock functions by that library are counted. Returns false if the library imports no
/// lock function.
bool countLocksOf(const std::string& file);

/// [any] Returns the number of locks so far, in all threads.
uint64_t locksCounted();

}  // namespace hapticd::conformance
