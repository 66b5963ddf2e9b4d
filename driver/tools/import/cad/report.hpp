// SPDX-License-Identifier: MIT
/// What an import did, for the person who started it.
#pragma once
#include <string>
#include <vector>

#include "kernels/brep/part.hpp"

namespace hapticd::cad {

struct Report {
  std::vector<std::string> steps;  ///< what was healed, sewn or recognised, in order
  std::size_t recognised = 0;      ///< spline faces that were planes, cylinders and the like
  double seconds = 0;
};

/// [main] Lines for a person: what is in the part, what was done, what was lost.
std::string textOf(const brep::Part& part, const Report& report, const std::string& out);

/// [main] The same for programs (JSON).
std::string jsonOf(const brep::Part& part, const Report& report, const std::string& out);

}  // namespace hapticd::cad
