// SPDX-License-Identifier: MIT
/// Warnings about hands that start inside a model, with the likely cause.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "description/scene.hpp"
#include "diagnostics/hand/hand_script.hpp"
#include "document/problem.hpp"
#include "host/shape_instance.hpp"

namespace hapticd::diagnostics {

/// A tip that is inside a model at the first tick.
struct InsideTip {
  size_t model = 0, device = 0;
  Eigen::Vector3d tip;             ///< [m] world
  double depth = 0;                ///< [m]
  bool beyond_box = false;         ///< the tip is outside the box round the model's surfaces, and no ball reaches in
  bool round = false;              ///< the centre of the hand's script is inside that box
  std::optional<double> radius{};  ///< [m] a hand.radius with which the hand starts outside and touches a model
};

/// Returns the radius [m] of the ball that touches the model (tip_radius), 0 for a point.
double ballOf(const scene::Model& model);

/// Returns true if the centre of the hand's script lies in the box of the model: the hand then moves round the model.
bool circlesModel(const scene::Device& device, const HandScript& hand, const scene::Model& model,
                  const host::ShapeInstance& shape);

/// Returns true if the whole box of the model lies nearer to the centre of the hand's script than the radius on which
/// the hand moves: the hand passes around it.
bool passesAround(const scene::Device& device, const HandScript& hand, const scene::Model& model,
                  const host::ShapeInstance& shape);

/// [main] Warns of one such tip. The warning is at the surfaces if they face the wrong way, at the radius of the hand
/// if another one helps, otherwise at the pose of the model.
void reportInside(const scene::Scene& scene, const InsideTip& inside, document::Problems& warnings);

}  // namespace hapticd::diagnostics
