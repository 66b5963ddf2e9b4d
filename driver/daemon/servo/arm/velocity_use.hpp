// SPDX-License-Identifier: MIT
/// Says whether anything in a run uses the velocity of an arm's tip.
#pragma once
#include "description/scene.hpp"

namespace hapticd::servo {

/// [any] True if something uses the velocity: servo.velocity must then name an estimator. @param models true if some
/// model reads the velocity
inline bool usesVelocity(const scene::Device& device, const scene::Clients& clients, bool models) {
  return models || clients.mode != scene::ClientMode::kOff || device.limits.velocity.value_or(0) > 0 ||
         device.limits.power > 0;
}

}  // namespace hapticd::servo
