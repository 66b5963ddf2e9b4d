// SPDX-License-Identifier: MIT
/// The rows of elements about a probe: while it stays there, a search need look at no others.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>

#include "kernels/brep/model.hpp"

namespace hapticd::brep {

/// What bounds the rows of elements, and how many are worth a look in one tick. Examining a spline leaf is expensive.
struct ElementLimits {
  using Shape = RowBox;
  static constexpr int kMostFours = 8;         ///< of rows
  static constexpr int kMostCandidates = 128;  ///< rows within reach, of which the nearest are taken
  static constexpr int kMostNodes = 32;        ///< nodes of the tree that one gathering examines
  static constexpr int kFew = 8, kMany = 20;
  static constexpr double kWorthIt = 1.5;  ///< times the way of a tick: below this, gathering costs more than it saves
  static constexpr bool kLearns = true;    ///< a measured distance bounds a row more closely than its shape
};
/// The same for triangles, which are cheap.
struct TriangleLimits {
  using Shape = RowSlab;
  static constexpr int kMostFours = 24, kMostCandidates = 96, kMostNodes = 128, kFew = 16, kMany = 32;
  static constexpr double kWorthIt = 4;
  static constexpr bool kLearns = false;
};

/// Rows whose boxes were within reach of a point, and a bound for all others: every distance changes by at most the way
/// of the probe. Source: the neighbour lists of Verlet 1967, "Computer experiments on classical fluids". A distance
/// that was measured to an element bounds it in the same way until the probe has come as much nearer.
template <class Choice>
class NearRows {
 public:
  using Limits = Choice;
  using Shape = typename Limits::Shape;
  using Four = decltype(emptyFour(Shape{}));
  static constexpr int kMostRows = 4 * Limits::kMostFours;

  /// [rt] Takes the rows of a body that may be within `reach` [m] of p (frame of the body), the nearest ones if they
  /// are many. False means that nothing is known, because there are far too many.
  bool gather(const BodyTree& body, const Eigen::Vector3d& p, double reach) noexcept;
  /// [rt] The probe has moved by this way [m].
  void go(double way) noexcept { gone_ += way; }
  /// [rt] From now on nothing is known.
  void forget() noexcept { beyond_ = -1; }
  /// [rt] No element of other rows is nearer to p than this [m]. Below 0 nothing is known.
  double beyond(const Eigen::Vector3d& p) const noexcept { return beyond_ - (p - center_).norm(); }
  /// [rt] No element of a row is nearer to the present probe than the square root of this [m].
  void learn(int four, int lane, double distance2) noexcept {
    if constexpr (!Limits::kLearns) return;
    constexpr double kRoundedDown = 1 - 1e-6;
    known_[static_cast<std::size_t>(four)][lane] = static_cast<float>((std::sqrt(distance2) + gone_) * kRoundedDown);
  }

  int rows() const noexcept { return rows_; }
  int fours() const noexcept { return (rows_ + 3) / 4; }
  /// [rt] Lower bounds of the squared distances [m^2] to four rows.
  Float4 distances(int four, const BoxProbe& probe) const noexcept {
    constexpr Float4 kZero{};
    const Float4 boxes = rowDistances(fours_[static_cast<std::size_t>(four)], probe);
    if constexpr (!Limits::kLearns) return boxes;
    const Float4 left = known_[static_cast<std::size_t>(four)] - static_cast<float>(gone_ * (1 + 1e-6));
    const Float4 known = (left > kZero ? left : kZero) * (left > kZero ? left : kZero) * kRowShare;
    return boxes > known ? boxes : known;
  }
  ElementRow row(int four, int lane) const noexcept {
    return BoxTree::rowOf(children_[static_cast<std::size_t>(4 * four + lane)]);
  }

 private:
  struct Candidate {
    float bound2;
    std::int32_t row, child;
  };
  bool collect(const BodyTree& body, const Eigen::Vector3d& p, double reach2, double& beyond2) noexcept;
  void add(const Shape& shape, std::int32_t child) noexcept;

  std::array<Four, Limits::kMostFours> fours_;
  std::array<Float4, Limits::kMostFours> known_{};  ///< [m] measured distances, and the way until then
  std::array<std::int32_t, kMostRows> children_{};
  Eigen::Vector3d center_{0, 0, 0};
  double beyond_ = -1;
  double gone_ = 0;  ///< [m] way of the probe since the rows were gathered
  int rows_ = 0;
  std::array<Candidate, Limits::kMostCandidates> candidates_;
  int candidate_count_ = 0;
};

using NearElements = NearRows<ElementLimits>;
using NearTriangles = NearRows<TriangleLimits>;
extern template class NearRows<ElementLimits>;
extern template class NearRows<TriangleLimits>;

}  // namespace hapticd::brep
