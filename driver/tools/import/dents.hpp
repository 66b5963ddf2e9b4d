// SPDX-License-Identifier: MIT
/// How far beside a press the surface of a soft body goes down, and the shear reach that makes it so.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "host/catalog.hpp"

namespace hapticd::importing {

inline constexpr std::size_t kMostTableBytes = std::size_t{1} << 26;  ///< of a CSV file of presses or dents

/// A press at one place and its effect at another.
struct Dent {
  Eigen::Vector3d pressed, beside;  ///< [m] places of the surface
  double share;                     ///< share of the press's depth by which `beside` sinks
};

/// [main] CSV x,y,z,x2,y2,z2,dent.
Result<std::vector<Dent>> readDents(const std::string& file);

/// [main] What a body does at each of `dents`, by two probes that press it a little.
Result<std::vector<double>> dentsOf(const std::string& body, const std::vector<Dent>& dents, host::Catalog& catalog);

struct ReachFit {
  double reach = 0;            ///< [m]
  std::vector<double> shares;  ///< error of the body that has this reach
};

/// [main] The shear reach from 0 to `most` [m] with the least squares. `write(reach)` writes such a body to `file`.
Result<ReachFit> fitReach(const std::string& file, double most, const std::vector<Dent>& dents,
                          const std::function<Result<void>(double)>& write, host::Catalog& catalog);

}  // namespace hapticd::importing
