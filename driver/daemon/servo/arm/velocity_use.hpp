// SPDX-License-Identifier: MIT
/// Says whether anything in a run uses the velocity of an arm's tip.
#pragma once
#include <string_view>

#include "description/scene.hpp"

namespace hapticd::servo {

/// [any] Returns the key that, beside the models, asks for the velocity of this arm's tip; "" if none does.
inline std::string_view keyThatUsesVelocity(const scene::Device& device, const scene::Clients& clients) {
  if (clients.mode != scene::ClientMode::kOff) return "clients";
  if (device.limits.velocity.value_or(0) > 0) return "limits.velocity";
  return device.limits.power > 0 ? "limits.power" : "";
}

/// [any] True if something uses the velocity: servo.velocity must then name an estimator. @param models true if some
/// model reads the velocity
inline bool usesVelocity(const scene::Device& device, const scene::Clients& clients, bool models) {
  return models || !keyThatUsesVelocity(device, clients).empty();
}

}  // namespace hapticd::servo
