// SPDX-License-Identifier: MIT
/// Triangles that are so narrow that the rounding of their corners may decide where they look. Some files have them
/// beside points that a program put on an edge. A foot must not be held there, and their normals must not decide a
/// side.
#pragma once
#include <array>
#include <cstdint>

#include "kernels/brep/model/model.hpp"

namespace hapticd::brep {

/// [rt] The nearest point of a triangle to p.
Hit footOn(const Part& part, std::uint32_t triangle, const Eigen::Vector3d& p) noexcept;

/// [any] True if the height of a triangle over its longest edge is less than 1/256 of that edge, and less than a tenth
/// of a distance.
bool isNarrow(const Part& part, std::uint32_t triangle, double distance) noexcept;

/// [any] True if a triangle has a corner in common with one that is narrow, if it is far enough away.
bool isBesideNarrow(const Model& model, std::uint32_t triangle) noexcept;

/// [any] True if a triangle looks to the same side as a normal, as those on both sides of an edge do that is no blade.
bool looksAlong(const Part& part, std::uint32_t triangle, const Eigen::Vector3d& normal) noexcept;

/// The triangles that a foot on a triangle reaches over narrow ones, or about a corner, within a tenth of the distance
/// from the probe to this foot.
class NearFoot {
 public:
  /// [rt] @param triangle that has the foot; it is the first one
  NearFoot(const Part& part, std::uint32_t triangle, const Eigen::Vector3d& foot, double distance) noexcept;

  std::size_t count() const noexcept { return count_; }
  std::uint32_t operator[](std::size_t i) const noexcept { return found_[i]; }
  bool narrow(std::size_t i) const noexcept { return narrow_[i]; }
  bool hasNarrow() const noexcept;
  /// Returns the first triangle but the given one that is not narrow and looksAlong() a normal, or kNone.
  std::uint32_t nextWide(const Part& part, std::uint32_t triangle, const Eigen::Vector3d& normal) const noexcept;
  /// Returns an outward normal at the foot for a probe at r from it, by which the side of the probe is decided, from
  /// the triangles that are not narrow; 0 if these do not decide it, as beside a foil, whose narrow border is real.
  Eigen::Vector3d normalToward(const Part& part, const Eigen::Vector3d& r) const noexcept;

 private:
  static constexpr std::size_t kMost = 32;  // a tick has no time for more
  bool has(std::uint32_t triangle) const noexcept;

  std::array<std::uint32_t, kMost> found_{};
  std::array<bool, kMost> narrow_{};
  std::size_t count_ = 0;
};

}  // namespace hapticd::brep
