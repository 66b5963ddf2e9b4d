// SPDX-License-Identifier: MIT
/// Factors between the units of the HDAPI (mm, mN m) and the SI units of the daemon.
#pragma once

namespace hapticd::hd {

inline constexpr double kMmPerMetre = 1000;  ///< also turns N m into mN m
inline constexpr double kNsPerSecond = 1e9;

}  // namespace hapticd::hd
