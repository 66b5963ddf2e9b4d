// SPDX-License-Identifier: MIT
/// How much of a sweep a test does: a part that stands for the whole, or in `tests/run long` the whole.
#pragma once
#include <cstdlib>

namespace hapticd::support {

inline const bool kLong = std::getenv("HAPTICD_LONG") != nullptr;

}  // namespace hapticd::support
