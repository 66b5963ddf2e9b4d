// SPDX-License-Identifier: MIT
/// A button that is pressed and does not click.
#pragma once
#include "description/scene.hpp"
#include "diagnostics/hand_walk.hpp"
#include "document/problem.hpp"
#include "host/shape_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Judges a model that has a detent and was touched. @param whole the hand went everywhere it goes
/// @return a warning was told
bool tellNoClick(const scene::Model& model, size_t index, const host::ShapeInstance& shape, const WalkedModel& seen,
                 bool whole, document::Problems& warnings);

}  // namespace hapticd::diagnostics
