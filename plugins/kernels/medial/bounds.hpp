// SPDX-License-Identifier: MIT
/// Bounds that several files of this room hold to.
#pragma once

namespace hapticd::medial {

inline constexpr double kNearAxis = 1e-4;        ///< [m] nearer than this, the direction to the probe means little
inline constexpr double kSteepestRadius = 0.99;  ///< slope of the radius above which spheres are nested

}  // namespace hapticd::medial
