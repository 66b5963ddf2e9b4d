// SPDX-License-Identifier: MIT
/// Judges servo.velocity, depth_scale and servo.hysteresis: finds values that `run` refuses, and values with which
/// damping acts late or not at all.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Returns a problem, with the text of `run`, if `run` would refuse servo.velocity. If nothing in the scene uses
/// a velocity, adds it to `idle` as a warning instead.
/// @param needs_velocity true if some model reads the velocity of a probe
document::Problems refusedVelocity(const scene::Scene& scene, bool needs_velocity, document::Problems& idle);

/// [main] Warns of an estimator that lags so much that damping still pushes in the old direction after the hand has
/// turned round.
document::Problems lateVelocity(const scene::Scene& scene, bool needs_velocity);

/// [main] Warns of a depth_scale (the depth with full damping) or a hysteresis that is far too long for a scene.
document::Problems wideScales(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
