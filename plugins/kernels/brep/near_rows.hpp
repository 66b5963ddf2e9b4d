// SPDX-License-Identifier: MIT
/// The rows of triangles about a probe: while it stays there, a search need look at no others.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "kernels/brep/model.hpp"

namespace hapticd::brep {

/// Rows whose boxes were within reach of a point, and a bound for all others: every distance changes by at most the way
/// of the probe. Source: the neighbour lists of Verlet 1967, "Computer experiments on classical fluids".
class NearRows {
 public:
  static constexpr int kMostFours = 24;
  static constexpr int kMostElements = 4 * kMostFours * BodyTree::kMeshRow;

  /// [rt] Takes all rows of a mesh that may be within `reach` [m] of p (frame of the body). False, and then nothing is
  /// known: they are too many.
  bool gather(const BodyTree& body, const Eigen::Vector3d& p, double reach) noexcept;
  /// [rt] No element of other rows is nearer to p than this [m]. Below 0: nothing is known.
  double beyond(const Eigen::Vector3d& p) const noexcept { return beyond_ - (p - center_).norm(); }

  int rows() const noexcept { return rows_; }
  int fours() const noexcept { return (rows_ + 3) / 4; }
  const FourSlabs& four(int i) const noexcept { return fours_[static_cast<std::size_t>(i)]; }
  ElementRow row(int four, int lane) const noexcept {
    return BoxTree::rowOf(children_[static_cast<std::size_t>(4 * four + lane)]);
  }

 private:
  void add(const RowSlab& slab, std::int32_t child) noexcept;

  std::array<FourSlabs, kMostFours> fours_;
  std::array<std::int32_t, 4 * std::size_t{kMostFours}> children_{};
  Eigen::Vector3d center_{0, 0, 0};
  double beyond_ = -1;
  int rows_ = 0;
};

}  // namespace hapticd::brep
