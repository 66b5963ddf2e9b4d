// SPDX-License-Identifier: MIT
/// The damping that an arm needs so that its contact with a felt surface is passive for every person who holds the arm.
#pragma once
#include "kernels/medial/viscoelastic.hpp"

namespace hapticd::medial {

/// [main] Returns the damping [N s/m] of an arm above which the contact with a sampled surface is passive, if the force
/// is held for each tick of T = `dt` [s]. It is the greatest value of T / 2 / (1 - cos wT) * Re((1 - exp(-iwT))
/// H(exp(iwT))) for frequencies w up to half the sampling rate (Colgate and Schenkel 1997). H is the transfer function
/// from depth to force of the integration scheme in use. A spring alone needs K T / 2; a mass behind the contact
/// resonates and needs more.
/// @return HUGE_VAL for an undamped mass, because on every arm some hand can excite its resonance
double passiveDamping(const SurfaceElement& element, double dt);

}  // namespace hapticd::medial
