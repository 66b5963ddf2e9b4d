// SPDX-License-Identifier: MIT
/// Judges servo.velocity and the distances of servo: what `run` refuses, and what makes damping act late or not at all.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] A problem where `run` would refuse servo.velocity, in its words; the same as a warning in `idle` where
/// nothing in the scene uses a velocity. @param needs_velocity some model reads the velocity of a probe
document::Problems refusedVelocity(const scene::Scene& scene, bool needs_velocity, document::Problems& idle);

/// [main] Warns of an estimate that lags so far that damping pushes when the hand has turned round.
document::Problems lateVelocity(const scene::Scene& scene, bool needs_velocity);

/// [main] Warns of a depth_scale, at which damping is what the file says, or of a hysteresis, that is no length of a
/// scene.
document::Problems wideScales(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
