// SPDX-License-Identifier: MIT
/// The elements around a probe in a model of several placements. Each placement within reach keeps its own list, in the
/// frame of its body.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "kernels/brep/search/near_rows.hpp"

namespace hapticd::brep {

class NearPlaces {
 public:
  static constexpr int kMostPlaces = 4;
  static constexpr int kMostRows = kMostPlaces * NearElements::kMostRows;
  using Limits = ElementLimits;
  /// If a search of the whole model examines fewer nodes of its trees than this, gathering elements would cost more
  /// than it saves.
  static constexpr int kFewestNodes = 24;

  /// The elements near the probe in one placement.
  struct Near {
    std::uint32_t place = 0;
    NearElements elements;
  };

  /// [rt] Collects the elements that may be within `reach` [m] of p (frame of the model). Returns false, and then
  /// nothing is known, if there are too many placements or elements near p, or if one of the bodies is a mesh.
  bool gather(const Model& model, const Eigen::Vector3d& p, double reach) noexcept;
  /// [rt] Tells that the probe has moved by this distance [m].
  void probeMoved(double way) noexcept {
    for (int i = 0; i < count_; ++i) places_[static_cast<std::size_t>(i)].elements.probeMoved(way);
  }
  /// [rt] Forgets the collected elements; beyond() is then below 0.
  void forget() noexcept { count_ = 0, beyond_ = -1; }
  /// [rt] Returns a lower bound of the distance [m] from p to every element that was not collected. If it is below 0,
  /// nothing is known.
  double beyond(const Eigen::Vector3d& p) const noexcept { return beyond_ - (p - center_).norm(); }
  /// [any] Returns the number of collected rows in all placements.
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
