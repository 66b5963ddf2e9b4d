// SPDX-License-Identifier: MIT
#include "kernels/brep/search/near_planes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::brep {

using Eigen::Vector3d;

void NearPlanes::make(const NearTriangles& near, const BoxProbe& probe, const Vector3d& p, double reach) noexcept {
  center_ = p;
  reach_ = reach;
  rows_ = near.rows();
  row_fours_ = near.fours();
  triangles_ = 0;
  for (int k = 0; k < row_fours_; ++k) {
    const DiscPlanes planes = discPlanes(near.shapes(k), probe);
    fours_[static_cast<std::size_t>(k)] = {{planes.normal[0], planes.normal[1], planes.normal[2]}, planes.distance};
  }
}

int NearPlanes::add(Element triangle) noexcept {
  const int plane = 4 * row_fours_ + triangles_;
  if (triangles_ % 4 == 0) at(plane) = {{}, kEndless4};
  of_[static_cast<std::size_t>(triangles_++)] = triangle;
  return plane;
}

int NearPlanes::find(Element triangle, int likely) const noexcept {
  const int first = 4 * row_fours_;
  if (likely >= first && likely < first + triangles_ && this->triangle(likely) == triangle) return likely;
  for (int i = 0; i < triangles_; ++i)
    if (of_[static_cast<std::size_t>(i)] == triangle) return first + i;
  return kNowhere;
}

void NearPlanes::learn(int plane, const Vector3d& p, const Vector3d& foot,
                       const std::array<Vector3d, 3>& corners) noexcept {
  constexpr double kShorter = 1 - 4e-7;  // so that the normal, after rounding, is not longer than 1
  constexpr double kLeast2 = 1e-200;     // [m^2] nearer to a triangle, no direction is known
  const Vector3d way = p - foot;
  const double d2 = way.squaredNorm(), share = d2 > kLeast2 ? kShorter / std::sqrt(d2) : 0;
  const Eigen::Vector3f n = (share * way).cast<float>();
  const Vector3d normal = n.cast<double>();
  double high = -std::numeric_limits<double>::infinity();  // of the corners, so that no error of the foot matters
  for (const Vector3d& corner : corners) high = std::max(high, normal.dot(corner - center_));
  Four& four = at(plane);
  for (int axis = 0; axis < 3; ++axis) putLane(four.normal[axis], plane % 4, n[axis]);
  putLane(four.offset, plane % 4, static_cast<float>(-high - 2e-7 * std::abs(high)));
}

}  // namespace hapticd::brep
