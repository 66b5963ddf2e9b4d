// SPDX-License-Identifier: MIT
/// The elements about a probe among several placements: of each placement within reach its own, in its own frame.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "kernels/brep/near_rows.hpp"

namespace hapticd::brep {

class NearPlaces {
 public:
  static constexpr int kMostPlaces = 4;
  static constexpr int kMostRows = kMostPlaces * NearElements::kMostRows;
  using Limits = ElementLimits;
  /// Boxes of four: if a search of the whole model examines fewer, it is as good as these elements, and gathering costs
  /// more.
  static constexpr int kDear = 24;

  /// The elements near the probe in one placement.
  struct Near {
    std::uint32_t place = 0;
    NearElements elements;
  };

  /// [rt] Collects what may be within `reach` [m] of p (frame of the model). False means that nothing is known: there
  /// are too many placements or elements there, or one is a mesh.
  bool gather(const Model& model, const Eigen::Vector3d& p, double reach) noexcept;
  /// [rt] The probe has moved by this way [m].
  void go(double way) noexcept {
    for (int i = 0; i < count_; ++i) places_[static_cast<std::size_t>(i)].elements.go(way);
  }
  /// [rt] From now on nothing is known.
  void forget() noexcept { count_ = 0, beyond_ = -1; }
  /// [rt] Nothing else is nearer to p than this [m]. Below 0 nothing is known.
  double beyond(const Eigen::Vector3d& p) const noexcept { return beyond_ - (p - center_).norm(); }
  /// [any] Of all placements.
  int rows() const noexcept;
  int count() const noexcept { return count_; }
  Near& operator[](int i) noexcept { return places_[static_cast<std::size_t>(i)]; }

 private:
  bool collect(const Model& model, const Eigen::Vector3d& p, double reach2, double& beyond2) noexcept;
  bool add(const Model& model, std::uint32_t place, const Eigen::Vector3d& p, double reach) noexcept;

  std::array<Near, kMostPlaces> places_;
  Eigen::Vector3d center_{0, 0, 0};
  double beyond_ = -1;
  int count_ = 0;
};

}  // namespace hapticd::brep
