// SPDX-License-Identifier: MIT
/// What the conformance tests of all kinds are made of.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "conformance/conformance.hpp"

namespace hapticd::conformance {

constexpr double kConformanceDt = 1e-3;  ///< [s] of every step
constexpr int kConformanceSteps = 2000;  ///< once around the path

/// Gives an active instance, or is why there is none.
struct Made {
  std::unique_ptr<Subject> subject;
  std::string error;
  explicit Made(const Recipe& recipe, uint32_t probes = 1);
};

std::string text(double value);

/// A smooth closed path through and around the shape, from a corner outside its box and back to it.
Eigen::Vector3d onPath(const Subject& subject, double part, double phase = 0);

/// Runs along the path, then presses wherever the shape can be touched, and hands every answer to `look`; its first
/// objection ends the run.
std::string along(Subject& subject, const std::function<std::string(const Answer&, const Eigen::Vector3d&)>& look,
                  int steps = kConformanceSteps);

/// "": a status that a step may have, and an answer that is finite.
std::string wrongStatus(const Answer& answer);

const hsp_param& paramAt(const hsp_class& c, uint32_t i);

}  // namespace hapticd::conformance
