// SPDX-License-Identifier: MIT
/// Describes one feature of a part, so that it can be found in the program that drew it.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernels/part/part.hpp"

namespace hapticd::cli {

/// [main] Returns the feature of this number, or of this name as brep::featureName() and messages have it: "bolt: face
/// 3". The name of an instance may stand without its assemblies, the first one counts. Nothing if there is none.
std::optional<std::uint32_t> featureCalled(const brep::Part& part, const std::string& asked);

/// [main] Returns the kind, size and place of a feature, such as "a cylinder of radius 5 mm, 10 x 10 x 20 mm large,
/// middle at (0, 0, 10) mm, axis through (0, 0, 10) mm along (0, 0, 1)". If it has an axis, a second line gives the
/// keys of a scene that make a hinge of it. The coordinates are those of the part. @throws std::invalid_argument if the
/// part cannot be searched
std::string featureText(const brep::Part& part, std::uint32_t feature);

/// [main] Returns a line for each axis about which round faces (cylinders, cones, tori, revolutions) of an instance
/// lie, such as "engine/crank: joint: hinge, pivot: [0, 0, 0.01], axis: [0, 0, 1]  (a cylinder of radius 5 mm: feature
/// 10)", in the order of the features. @throws std::invalid_argument if the part cannot be searched
std::vector<std::string> axisLines(const brep::Part& part);

}  // namespace hapticd::cli
