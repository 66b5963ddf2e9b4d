// SPDX-License-Identifier: MIT
/// Programs of the HDAPI count in mm and mN m, the daemon in SI units.
#pragma once

namespace hapticd::hd {

inline constexpr double kMmPerMetre = 1000;  ///< also mN m of an N m
inline constexpr double kNsPerSecond = 1e9;

}  // namespace hapticd::hd
