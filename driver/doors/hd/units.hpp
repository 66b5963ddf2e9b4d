// SPDX-License-Identifier: MIT
/// The HDAPI has mm and mN m; the daemon has SI units.
#pragma once

namespace hapticd::hd {

inline constexpr double kMmPerMetre = 1000;  ///< also turns N m into mN m
inline constexpr double kNsPerSecond = 1e9;

}  // namespace hapticd::hd
