// SPDX-License-Identifier: MIT
/// Searches for a nearer part of a skeleton while a probe is pressed in. In a valley two flanks are nearly equally
/// near, and Newton's method follows only one of them.
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
  explicit FootScan(const medial::Skeleton& skeleton);  ///< [main] makes the samples
  /// [rt] Examines the next samples in turn and begins again after the last sample.
  /// @param width [m] a foot that is certainly at another place may be less deep by this much
  /// @param next in: index of the sample that was examined last; out: the new one
  /// @return the parameters of the best sample at another place whose foot may be nearer to p than `foot`, or farther
  /// away by at most `width`
  std::optional<std::array<double, 2>> rival(const Eigen::Vector3d& p, const medial::SkeletonFoot& foot, double width,
                                             uint32_t& next) const noexcept;
  /// [rt] Returns 0 if two feet are at the same place of the skeleton, 1 if they are at two places, and values between
  /// if the two places are close together.
  static double apart(const medial::SkeletonFoot& a, const medial::SkeletonFoot& b) noexcept;
  std::size_t bytes() const noexcept {
    return samples_.capacity() * sizeof(Sample) + 4 * x_.capacity() * sizeof(float);
  }

 private:
  struct Sample {
    Eigen::Vector3d center;
    double radius, u, v;
  };
  /// A probe and the conditions for samples, in the same units as x_.
  struct Probe {
    Eigen::Vector3f p, normal;
    float deepest, width;
  };
  void scale();
  uint32_t nextGroup(const Probe& probe, uint32_t first, uint32_t k, uint32_t looks) const noexcept;
  static bool nearer(const Sample& sample, const Eigen::Vector3d& p, const medial::SkeletonFoot& foot, double width,
                     double& deepest) noexcept;

  std::vector<Sample> samples_;
  // The samples again, relative to `middle_` and divided by `size_`. The first ones are repeated after the last one.
  std::vector<float> x_, y_, z_, radius_;
  Eigen::Vector3d middle_{0, 0, 0};
  double size_ = 1;  ///< [m] half the size of the body
};

}  // namespace hapticd
