// SPDX-License-Identifier: MIT
/// The force in a valley of a felt body or of a mesh, where the probe is nearly equally deep below two parts of the
/// surface.
#pragma once
#include "soft_body.hpp"

namespace hapticd {

/// [rt] Returns the weight of the rival (Track::rival, the foot on the other flank) relative to the foot: 0 if the
/// rival adds nothing, 1 if the probe is equally deep below both flanks.
/// @param width [m] if the depths differ by this or more, the rival does not count
double rivalShare(const Track& track, double width) noexcept HSP_RT;

/// [rt] Returns the felt surface in a valley. Its depth is a smooth maximum of the depths below the two flanks, and its
/// direction is the gradient of this depth. So the force has a potential energy that does not depend on the flank from
/// which the probe comes.
Felt feltInCrease(const Felt& felt, const Track& track, double width) noexcept HSP_RT;

/// [rt] Mixes the nodes and the stiffness of `other`, the place at the rival, into `place`. @param share weight of
/// `other`, 0 to 1
void mixPlaces(const medial::FeltPlace& other, double share, medial::FeltPlace& place) noexcept HSP_RT;

}  // namespace hapticd
