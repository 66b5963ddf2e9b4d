// SPDX-License-Identifier: MIT
/// How large a part file may be.
#pragma once
#include <cstddef>

namespace hapticd::brep {

/// Largest part file that is read [bytes]. A part needs about its own size again in memory.
inline constexpr std::size_t kMostPartBytes = std::size_t{4} << 30;

}  // namespace hapticd::brep
