// SPDX-License-Identifier: MIT
/// Measures how far the surface of a soft body sinks beside a press, and finds the shear reach that fits measured
/// dents.
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

/// A press at one point of the surface, and its effect at another.
struct Indentation {
  Eigen::Vector3d pressed, beside;  ///< [m] places of the surface
  double share;                     ///< distance by which `beside` sinks, divided by the depth of the press
};

/// [main] Reads a CSV file with the columns x,y,z,x2,y2,z2,dent.
Result<std::vector<Indentation>> readIndentations(const std::string& file);

/// [main] Measures Indentation::share of each of `dents` on a body. One probe presses the body a little, and a second
/// one measures the dent beside it.
Result<std::vector<double>> measureIndentations(const std::string& body, const std::vector<Indentation>& dents,
                                                host::Catalog& catalog);

struct ReachFit {
  double reach = 0;            ///< [m]
  std::vector<double> shares;  ///< Indentation::share of each dent, on a body with this reach
};

/// [main] Finds the shear reach from 0 to `most` [m] whose dents are nearest to the given ones (least squares).
/// @param write writes a body with the given reach to `file`
Result<ReachFit> fitReach(const std::string& file, double most, const std::vector<Indentation>& dents,
                          const std::function<Result<void>(double)>& write, host::Catalog& catalog);

}  // namespace hapticd::importing
