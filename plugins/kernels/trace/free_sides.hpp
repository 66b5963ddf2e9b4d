// SPDX-License-Identifier: MIT
/// Where a model ends: the sides of its patches that are joined to no other patch.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

#include "kernels/spline/surface_data.hpp"
#include "kernels/trace/patch.hpp"

namespace hapticd::trace {

/// A piece of a side: it lies within `radius` [m] of the segment from `start` to `start + along`.
struct SidePiece {
  Eigen::Vector3d start{0, 0, 0}, along{0, 0, 0};
  double radius = 0;

  double squaredDistanceToAxis(const Eigen::Vector3d& p) const noexcept;
};
using SidePieces = std::array<std::vector<SidePiece>, kSides>;

/// [main] Returns the pieces of the four sides of a surface, from the control points that each depends on.
SidePieces piecesOfSides(const spline::SurfaceData& data);

class FreeSides {
 public:
  /// [main] Keeps the pieces of those sides that are free. @param pieces one entry for each patch
  void keep(const std::vector<Patch>& patches, int shells, const std::vector<SidePieces>& pieces);
  /// [any] True if each free side of a shell is certainly farther from p than `reach` [m]. False if the shell has more
  /// of them than a tick can look at.
  bool areBeyond(int shell, const Eigen::Vector3d& p, double reach) const noexcept;
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::size_t kMostGroups = 512, kGroup = 16;

  /// Pieces that follow one another, with a box around them.
  struct Group {
    Eigen::AlignedBox3d box;
    std::size_t first = 0, count = 0;
  };
  void add(const SidePiece& piece, std::size_t shell);

  std::vector<SidePiece> pieces_;
  std::vector<Group> groups_;
  std::vector<std::size_t> first_group_;  ///< of each shell, and one more at the end
};

}  // namespace hapticd::trace
