// SPDX-License-Identifier: MIT
/// Warns of arms that are not stable at the rate of the servo, as their simulation shows.
#pragma once
#include <cstdint>

#include "description/scene.hpp"
#include "diagnostics/hand/hand_walk.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns at servo.rate if the tip of an arm swung faster than any hand moves. The bounds on the stiffness of a
/// wall know nothing of compliance control, whose loop goes through the arm's own. @return true if it warned
bool reportSwing(const scene::Scene& scene, uint32_t index, const WalkedArm& seen, document::Problems& warnings);

}  // namespace hapticd::diagnostics
