// SPDX-License-Identifier: MIT
/// Nearest of many points: a k-d tree over a fixed set.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hapticd::importing {

class NearestPoints {
 public:
  explicit NearestPoints(const std::vector<Eigen::Vector3d>& points);  ///< [main] points must outlive it
  /// Restricts which points count: seen from `from`, they lie deeper along `inward` than `sine` of their distance.
  struct Beyond {
    Eigen::Vector3d from, inward;
    double sine;
  };
  /// [main] Index of the point nearest to p; UINT32_MAX if there is none, or none nearer than `limit`.
  uint32_t nearest(const Eigen::Vector3d& p, const Beyond* only = nullptr, double limit = HUGE_VAL) const;

 private:
  void build(std::size_t first, std::size_t last);
  void look(std::size_t first, std::size_t last, const Eigen::Vector3d& p, const Beyond* only, uint32_t& best,
            double& best2) const;

  const std::vector<Eigen::Vector3d>& points_;
  std::vector<uint32_t> order_;  ///< the middle of each range is its root
  std::vector<uint8_t> axis_;    ///< axis by which a root divides its range
};

}  // namespace hapticd::importing
