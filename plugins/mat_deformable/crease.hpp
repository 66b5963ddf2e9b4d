// SPDX-License-Identifier: MIT
/// A valley of a felt body, where a second part of the surface is nearly as deep over the probe as the first.
#pragma once
#include "soft_body.hpp"

namespace hapticd {

/// [rt] How much the rival counts beside the foot: 0 to 1, where both are as deep.
/// @param width [m] difference of depths from which it does not count
double rivalShare(const Track& track, double width) noexcept HSP_RT;

/// [rt] The depth is a smooth maximum of both, and the direction its gradient: the force is that of an energy,
/// whichever flank the probe comes from.
Felt feltInCrease(const Felt& felt, const Track& track, double width) noexcept HSP_RT;

/// [rt] The place of the one foot with a share of the other's in it.
void mixPlaces(const medial::FeltPlace& other, double share, medial::FeltPlace& place) noexcept HSP_RT;

}  // namespace hapticd
