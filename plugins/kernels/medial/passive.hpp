// SPDX-License-Identifier: MIT
/// What an arm must damp to be passive on a felt surface, whoever holds it.
#pragma once
#include "kernels/medial/viscoelastic.hpp"

namespace hapticd::medial {

/// [main] Damping [N s/m] of an arm above which a sampled surface in contact, whose force is held for each tick of `dt`
/// [s], is passive: the greatest of T / 2 / (1 - cos wT) * Re((1 - exp(-iwT)) H(exp(iwT))) up to half the rate (Colgate
/// and Schenkel 1997), with H from the depth to the force of the scheme that runs. A spring alone needs
/// K T / 2; a mass behind the contact resonates and needs more.
/// @return HUGE_VAL for an undamped mass: some hand meets its resonance on every arm
double passiveDamping(const SurfaceElement& element, double dt);

}  // namespace hapticd::medial
