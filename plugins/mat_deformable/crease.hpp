// SPDX-License-Identifier: MIT
/// The force in a valley of a felt body, where the probe is nearly equally deep below two parts of the surface.
#pragma once
#include "soft_body.hpp"

namespace hapticd {

/// [rt] Returns how much the rival (Track::rival, the foot on the other flank) counts besides the foot: 0 if not at
/// all, 1 if the probe is equally deep below both.
/// @param width [m] if the depths differ by this or more, the rival does not count
double rivalShare(const Track& track, double width) noexcept HSP_RT;

/// [rt] Returns the felt surface in a valley. Its depth is a smooth maximum of both depths, and its direction is the
/// gradient of this depth. So the force has a potential energy, from whichever flank the probe comes.
Felt feltInCrease(const Felt& felt, const Track& track, double width) noexcept HSP_RT;

/// [rt] Adds a share of the other foot's place to `place`.
void mixPlaces(const medial::FeltPlace& other, double share, medial::FeltPlace& place) noexcept HSP_RT;

}  // namespace hapticd
