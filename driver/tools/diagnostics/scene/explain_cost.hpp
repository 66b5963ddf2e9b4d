// SPDX-License-Identifier: MIT
/// Measures what each part of a scene costs (time per tick and memory), with the line that asked for the part, and
/// lists the parts that do not exist because nothing asked for them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"

namespace hapticd::diagnostics {

/// One part of a run. Its cost is the time and the memory that a run without this part would save.
struct CostRow {
  std::string part;      ///< "model teapot", "velocity estimator"
  std::string asked_by;  ///< "file:line key"; empty if nothing asked for the part, so that it does not exist
  std::string why;       ///< why the part is needed, or why it is not
  double tick_ns = 0;    ///< [ns] mean time per tick over a motion of the hand
  uint64_t bytes = 0;
  bool there() const { return !asked_by.empty(); }
};

/// [main] Measures the scene on this machine, over a second of its hand's motion in virtual time, with and without each
/// part that a parameter asked for.
Result<std::vector<CostRow>> costOf(const scene::Scene& scene);

std::string costTable(const std::vector<CostRow>& rows);
std::string costJson(const std::string& scene, const std::vector<CostRow>& rows);

}  // namespace hapticd::diagnostics
