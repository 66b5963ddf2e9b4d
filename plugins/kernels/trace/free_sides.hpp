// SPDX-License-Identifier: MIT
/// Where a model ends: the sides of its patches that are joined to no other patch.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "kernels/spline/surface_data.hpp"
#include "kernels/trace/patch.hpp"

namespace hapticd::trace {

using SideBoxes = std::array<Eigen::AlignedBox3d, kSides>;

/// [main] Returns boxes around the four sides of a surface. They enclose the control points that the sides depend on.
SideBoxes boxesOfSides(const spline::SurfaceData& data);

class FreeSides {
 public:
  /// [main] Keeps the boxes of those sides that are free. @param boxes one entry for each patch
  void keep(const std::vector<Patch>& patches, const std::vector<SideBoxes>& boxes);
  /// [any] Returns a lower bound of the distance [m] from p to the free sides; infinity if there is none. It is 0 if
  /// there are more than a tick can look at.
  double atLeast(const Eigen::Vector3d& p) const noexcept;
  std::size_t bytes() const noexcept { return boxes_.capacity() * sizeof boxes_[0]; }

 private:
  static constexpr std::size_t kMost = 256;

  std::vector<Eigen::AlignedBox3d> boxes_;
};

}  // namespace hapticd::trace
