// SPDX-License-Identifier: MIT
/// How much of a sweep a test covers: a representative part or, in `tests/run long`, all of it.
#pragma once
#include <cstdlib>

namespace hapticd::support {

inline const bool kLong = std::getenv("HAPTICD_LONG") != nullptr;

}  // namespace hapticd::support
