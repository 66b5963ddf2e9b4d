// SPDX-License-Identifier: MIT
/// Finds buttons that a simulated hand presses and that do not click.
#pragma once
#include "description/scene.hpp"
#include "diagnostics/hand/hand_walk.hpp"
#include "document/problem.hpp"
#include "host/shape_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Judges a model that has a detent and was touched. @param whole true if the hand has done its whole motion
/// @return true if it added a warning
bool reportNoClick(const scene::Model& model, size_t index, const host::ShapeInstance& shape, const WalkedModel& seen,
                   bool whole, document::Problems& warnings);

}  // namespace hapticd::diagnostics
