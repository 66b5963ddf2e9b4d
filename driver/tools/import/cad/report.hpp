// SPDX-License-Identifier: MIT
/// The report of an import, for the person who started it.
#pragma once
#include <string>
#include <vector>

#include "cad_import/measures.hpp"
#include "kernels/part/part.hpp"

namespace hapticd::cad {

struct Report {
  std::vector<std::string> steps;  ///< what was healed, sewn or recognised, in order
  std::size_t recognised = 0;      ///< number of spline faces that were found to be planes, cylinders, cones or spheres
  Measures measures;               ///< of the part in its place
  double seconds = 0;
};

/// [main] Returns the report as text for a person: the contents of the part, the repairs, the warnings and the losses.
std::string textOf(const brep::Part& part, const Report& report, const std::string& out);

/// [main] Returns a warning about a part that is larger or smaller than a hand can feel, or "".
std::string oddSizeOf(const brep::Part& part, const Report& report, const std::string& out);

/// [main] Returns the lines of the report that are not yet among the part's warnings, so that `hapticd part info` has
/// them as well.
std::vector<std::string> stepsOf(const Report& report);

/// [main] Returns the same report for programs, as JSON.
std::string jsonOf(const brep::Part& part, const Report& report, const std::string& out);

}  // namespace hapticd::cad
