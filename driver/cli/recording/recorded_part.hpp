// SPDX-License-Identifier: MIT
/// Names of the faces that a recorded model has.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "description/scene.hpp"
#include "kernels/part/part.hpp"

namespace hapticd::cli {

/// [main] Reads the part of a model. Returns nothing if the model has none, or if the file cannot be read any more.
std::optional<brep::Part> partOf(const scene::Model& model);

/// Returns the name of a face with that of its instance; without a part "feature 7".
std::string featureNameIn(const std::optional<brep::Part>& part, std::uint32_t feature);

}  // namespace hapticd::cli
