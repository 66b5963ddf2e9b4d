// SPDX-License-Identifier: MIT
/// Names of the surfaces, instances, features and losses of a part, for messages.
#pragma once
#include <string>
#include <vector>

#include "kernels/part/part.hpp"

namespace hapticd::brep {

/// The kinds of surfaces, in the order of SurfaceKind.
inline constexpr const char* kSurfaceNames[] = {"plane",    "cylinder",  "cone",       "sphere", "torus",
                                                "B-spline", "extrusion", "revolution", "offset"};

/// Reason of a loss (Loss::reason) that is none to a person: the piece is there, within rounding.
inline constexpr const char* kApproximated = "approximated by a spline";

/// [main] Returns a line for each loss, and one line for all pieces that became splines.
std::vector<std::string> lossLines(const Part& part);

/// [main] Replaces the control characters of a UTF-8 text by spaces. Names from other programs' files are shown in
/// terminals, which would act on control characters.
std::string plainText(std::string text);

/// [main] Returns the name of an instance. If it has none, returns the name of its body, or else its number as "#3".
std::string instanceName(const Part& part, std::uint32_t instance);

/// [main] Returns the names from the outermost assembly down to an instance, separated by slashes.
std::string instancePath(const Part& part, std::uint32_t instance);

/// [main] Names the instance and the face of a feature, such as "bolt: face 3 'head'". Features are numbered over all
/// instances of the file. Returns "" if there is no such feature.
std::string featureName(const Part& part, std::uint32_t feature);

/// [main] Names a face (index in the part) as featureName() does, in the first instance of its body.
std::string faceName(const Part& part, std::uint32_t face);

}  // namespace hapticd::brep
