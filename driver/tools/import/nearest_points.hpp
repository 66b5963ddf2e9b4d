// SPDX-License-Identifier: MIT
/// Finds the nearest of many fixed points, with a k-d tree.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hapticd::importing {

class NearestPoints {
 public:
  explicit NearestPoints(const std::vector<Eigen::Vector3d>& points);  ///< [main] `points` must outlive this
  /// A restriction of the points: only points q with (q - from) . inward > sine * |q - from| count.
  struct HalfSpaceFilter {
    Eigen::Vector3d from, inward;
    double sine;
  };
  /// [main] Returns the index of the point nearest to p, or UINT32_MAX if no point counts or none is nearer than
  /// `limit`.
  uint32_t nearest(const Eigen::Vector3d& p, const HalfSpaceFilter* only = nullptr, double limit = HUGE_VAL) const;

 private:
  void build(std::size_t first, std::size_t last);
  void search(std::size_t first, std::size_t last, const Eigen::Vector3d& p, const HalfSpaceFilter* only,
              uint32_t& best, double& best2) const;

  const std::vector<Eigen::Vector3d>& points_;
  std::vector<uint32_t> order_;  ///< indices of the points; the middle of each range is the root of its subtree
  std::vector<uint8_t> axis_;    ///< axis (0 to 2) along which a root divides its range
};

}  // namespace hapticd::importing
