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
  /// @param width [m] by which a foot may be less deep, where it is surely of another place
  /// @return the parameters of the best that is apart from the foot and may be nearer to p, or by `width` less near
  std::optional<std::array<double, 2>> rival(const Eigen::Vector3d& p, const medial::SkeletonFoot& foot, double width,
                                             uint32_t& next) const noexcept;
  /// [rt] 0: two feet are of one place of the skeleton; 1: of two.
  static double apart(const medial::SkeletonFoot& a, const medial::SkeletonFoot& b) noexcept;
  std::size_t bytes() const noexcept {
    return samples_.capacity() * sizeof(Sample) + 4 * x_.capacity() * sizeof(float);
  }

 private:
  struct Sample {
    Eigen::Vector3d center;
    double radius, u, v;
  };
  /// A probe and what is asked of samples, likewise.
  struct Probe {
    Eigen::Vector3f p, normal;
    float deepest, width;
  };
  void scale();
  uint32_t nextGroup(const Probe& probe, uint32_t first, uint32_t k, uint32_t looks) const noexcept;
  static bool nearer(const Sample& sample, const Eigen::Vector3d& p, const medial::SkeletonFoot& foot, double width,
                     double& deepest) noexcept;

  std::vector<Sample> samples_;
  // The same about `middle_`, in lengths of `size_`, and once more from the beginning behind the end.
  std::vector<float> x_, y_, z_, radius_;
  Eigen::Vector3d middle_{0, 0, 0};
  double size_ = 1;  ///< [m]
};

}  // namespace hapticd
