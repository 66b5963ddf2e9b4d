// SPDX-License-Identifier: MIT
/// Who of a run asks for the velocity of an arm's tip.
#pragma once
#include "description/scene.hpp"

namespace hapticd::servo {

/// [any] Something does, so that servo.velocity must be one that there is. @param models some model reads it
inline bool usesVelocity(const scene::Device& device, const scene::Clients& clients, bool models) {
  return models || clients.mode != scene::ClientMode::kOff || device.limits.velocity.value_or(0) > 0 ||
         device.limits.power > 0;
}

}  // namespace hapticd::servo
