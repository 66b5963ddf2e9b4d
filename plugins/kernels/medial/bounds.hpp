// SPDX-License-Identifier: MIT
/// Limits that several files of this folder share.
#pragma once

namespace hapticd::medial {

/// [m] if the probe is nearer to the skeleton than this, its direction from the skeleton is not reliable
inline constexpr double kNearAxis = 1e-4;
/// A greater slope of the radius is reduced to this. With a slope of 1 or more, spheres lie inside their neighbours.
inline constexpr double kSteepestRadius = 0.99;

}  // namespace hapticd::medial
