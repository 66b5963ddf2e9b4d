// SPDX-License-Identifier: MIT
/// Looks for a nearer part of a skeleton while a probe is pressed in: in a valley two flanks are nearly as near.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/medial/skeleton.hpp"

namespace hapticd {

class FootScan {
 public:
  explicit FootScan(const medial::Skeleton& skeleton);  ///< [main]
  /// [rt] Looks at the next samples, from `next` on, round and round.
  /// @return the parameters of the best that is apart from the foot and may be nearer to p
  std::optional<std::array<double, 2>> rival(const Eigen::Vector3d& p, const medial::SkeletonFoot& foot,
                                             uint32_t& next) const noexcept;
  /// [rt] 0: two feet are of one place of the skeleton; 1: of two.
  static double apart(const medial::SkeletonFoot& a, const medial::SkeletonFoot& b) noexcept;
  std::size_t bytes() const noexcept { return samples_.capacity() * sizeof(Sample); }

 private:
  struct Sample {
    Eigen::Vector3d center;
    double radius, u, v;
  };
  std::vector<Sample> samples_;
};

}  // namespace hapticd
