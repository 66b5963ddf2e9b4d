// SPDX-License-Identifier: MIT
/// Finds a hand.radius with which a simulated hand meets a model. Each is tried before it is advised, because a radius
/// that was only calculated need not lead to the surface: the hand may pass beside it, or start inside.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "description/scene.hpp"
#include "diagnostics/hand/hand_script.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the first of the radii with which the hand of an arm starts outside all models and touches one,
/// rounded to 0.1 mm; nothing if none of them does, or if trying them takes long.
std::optional<double> radiusThatTouches(const scene::Scene& scene, uint32_t device, const std::vector<double>& radii);

/// [main] Returns such a radius for a hand that comes no nearer than `away` [m] to a model. @param inwards true if the
/// model is nearer to the hand's centre than the hand, so that the radius must be smaller
std::optional<double> radiusOfFarHand(const scene::Scene& scene, uint32_t device, const HandScript& hand, double away,
                                      bool inwards);

/// [main] Returns such a radius for a hand that starts `depth` [m] inside a model.
std::optional<double> radiusOfInnerHand(const scene::Scene& scene, uint32_t device, const HandScript& hand,
                                        double depth);

}  // namespace hapticd::diagnostics
