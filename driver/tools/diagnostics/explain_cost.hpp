// SPDX-License-Identifier: MIT
/// What each part of a scene costs: time a tick and memory, the line that asked for it, and what is not there because
/// nothing asked for it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"

namespace hapticd::diagnostics {

/// One part of what runs. Its cost is what leaving it out would save.
struct CostRow {
  std::string part;      ///< "model teapot", "velocity estimator"
  std::string asked_by;  ///< "file:line key"; empty: nothing asked for it, so it does not exist
  std::string why;       ///< or why not
  double tick_ns = 0;    ///< mean over a stroke of the hand
  uint64_t bytes = 0;
  bool there() const { return !asked_by.empty(); }
};

/// [main] Measures the scene on this machine: over a second of its hand's motion, in virtual time, with and without
/// each part that a parameter asked for.
Result<std::vector<CostRow>> costOf(const scene::Scene& scene);

std::string costTable(const std::vector<CostRow>& rows);
std::string costJson(const std::string& scene, const std::vector<CostRow>& rows);

}  // namespace hapticd::diagnostics
