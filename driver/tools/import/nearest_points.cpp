// SPDX-License-Identifier: MIT
#include "import/nearest_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

namespace hapticd::importing {

using Eigen::Vector3d;

NearestPoints::NearestPoints(const std::vector<Vector3d>& points)
    : points_(points), order_(points.size()), axis_(points.size(), 0) {
  std::iota(order_.begin(), order_.end(), 0U);
  build(0, order_.size());
}

void NearestPoints::build(std::size_t first, std::size_t last) {
  if (last - first < 2) return;
  Eigen::AlignedBox3d box;
  for (std::size_t i = first; i < last; ++i) box.extend(points_[order_[i]]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t middle = (first + last) / 2;
  std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first),
                   order_.begin() + static_cast<std::ptrdiff_t>(middle),
                   order_.begin() + static_cast<std::ptrdiff_t>(last), [&](uint32_t a, uint32_t b) {
                     return points_[a][axis] < points_[b][axis] || (points_[a][axis] == points_[b][axis] && a < b);
                   });
  axis_[middle] = static_cast<uint8_t>(axis);
  build(first, middle);
  build(middle + 1, last);
}

uint32_t NearestPoints::nearest(const Vector3d& p, const HalfSpaceFilter* only, double limit) const {
  uint32_t best = UINT32_MAX;
  double best2 = limit * limit;
  search(0, order_.size(), p, only, best, best2);
  return best;
}

void NearestPoints::search(std::size_t first, std::size_t last, const Vector3d& p, const HalfSpaceFilter* only,
                           uint32_t& best, double& best2) const {
  if (first == last) return;
  const std::size_t middle = (first + last) / 2;
  const uint32_t root = order_[middle];
  const double d2 = (points_[root] - p).squaredNorm();
  const auto counts = [&](const Vector3d& q) {
    return only == nullptr || only->inward.dot(q - only->from) > only->sine * (q - only->from).norm();
  };
  if (d2 < best2 && counts(points_[root])) {
    best2 = d2;
    best = root;
  }
  const double beyond = p[axis_[middle]] - points_[root][axis_[middle]];
  beyond < 0 ? search(first, middle, p, only, best, best2) : search(middle + 1, last, p, only, best, best2);
  if (beyond * beyond < best2)
    beyond < 0 ? search(middle + 1, last, p, only, best, best2) : search(first, middle, p, only, best, best2);
}

}  // namespace hapticd::importing
