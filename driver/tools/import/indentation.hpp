// SPDX-License-Identifier: MIT
/// Measures how far the surface of a soft body sinks beside a press, and finds the shear reach that fits given dents.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "host/catalog.hpp"

namespace hapticd::importing {
/// [bytes] Largest size of a CSV file of presses or dents.
inline constexpr std::size_t kMostTableBytes = std::size_t{1} << 26;

/// A press at one place and its effect at another.
struct Indentation {
  Eigen::Vector3d pressed, beside;  ///< [m] places of the surface
  double share;                     ///< share of the press's depth by which `beside` sinks
};

/// [main] Reads a CSV file with the columns x,y,z,x2,y2,z2,dent.
Result<std::vector<Indentation>> readIndentations(const std::string& file);

/// [main] Measures the share of each of `dents` on a body, with two probes that press it a little.
Result<std::vector<double>> measureIndentations(const std::string& body, const std::vector<Indentation>& dents,
                                                host::Catalog& catalog);

struct ReachFit {
  double reach = 0;            ///< [m]
  std::vector<double> shares;  ///< share at each of the dents of a body with this reach
};

/// [main] Finds the shear reach from 0 to `most` [m] that gives the given dents best (least squares). `write(reach)`
/// writes a body with that reach to `file`.
Result<ReachFit> fitReach(const std::string& file, double most, const std::vector<Indentation>& dents,
                          const std::function<Result<void>(double)>& write, host::Catalog& catalog);

}  // namespace hapticd::importing
