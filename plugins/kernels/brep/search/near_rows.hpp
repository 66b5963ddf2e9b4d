// SPDX-License-Identifier: MIT
/// The rows of elements around a probe. While the probe stays near, a search needs to examine no other rows.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>

#include "kernels/brep/model/model.hpp"

namespace hapticd::brep {

/// Limits for bodies of faces and edges: how many rows are gathered and examined in one tick. They are low, because the
/// foot on a spline leaf costs several evaluations.
struct ElementLimits {
  using Shape = RowBox;
  static constexpr int kMostFours = 8;         ///< most groups of four rows
  static constexpr int kMostCandidates = 128;  ///< most rows within reach, from which the nearest are taken
  static constexpr int kMostNodes = 32;        ///< most nodes of the tree that gather() examines
  static constexpr int kOpenAtOnce = 2;        ///< nodes that gather() opens at once
  static constexpr int kMostListed = 80;       ///< most shapes that gather() measures
  static constexpr int kFew = 8, kMany = 20;   ///< the reach grows below kFew rows and shrinks above kMany
  /// Rows are gathered for several ticks only if the reach is at least this many times the probe's motion per tick.
  static constexpr double kWorthIt = 1;
  /// Measured distances are kept, because they bound a row more closely than its shape does.
  static constexpr bool kLearns = true;
};
/// The same limits for meshes. They are higher, because the foot on a triangle costs little.
struct TriangleLimits {
  using Shape = RowDisc;
  static constexpr int kMostFours = 24, kMostCandidates = 96, kMostNodes = 128, kOpenAtOnce = 4, kMostListed = 192,
                       kFew = 16, kMany = 32;
  static constexpr double kWorthIt = 2;
  static constexpr bool kLearns = false;
};

/// The rows whose boxes were within reach of a point, and a lower bound of the distance to all other rows. The bound
/// stays usable because every distance changes by at most the distance that the probe moves. Source: the neighbour
/// lists of Verlet 1967, "Computer experiments on classical fluids". Likewise, the measured distance to an element,
/// less the distance moved since then, is a lower bound.
template <class Choice>
class NearRows {
 public:
  using Limits = Choice;
  using Shape = typename Limits::Shape;
  using Four = decltype(fourOf(Shape{}, Shape{}, Shape{}, Shape{}));
  static constexpr int kMostRows = 4 * Limits::kMostFours;

  /// [rt] Takes the rows of a body that may be within `reach` [m] of p (frame of the body); if they are too many, only
  /// the nearest ones. Returns false, and then nothing is known, if the search exceeds kMostNodes or kMostCandidates.
  bool gather(const BodyTree& body, const Eigen::Vector3d& p, double reach) noexcept;
  /// [rt] Tells that the probe has moved by this distance [m].
  void probeMoved(double way) noexcept { moved_ += way; }
  /// [rt] Forgets the rows; beyond() is then below 0.
  void forget() noexcept { beyond_ = -1; }
  /// [rt] Returns a lower bound of the distance [m] from p to every element of the other rows. If it is below 0,
  /// nothing is known.
  double beyond(const Eigen::Vector3d& p) const noexcept { return beyond_ - (p - center_).norm(); }
  /// [rt] Records that no element of a row is nearer to the present probe than sqrt(distance2). @param distance2 [m^2]
  void learn(int four, int lane, double distance2) noexcept {
    if constexpr (!Limits::kLearns) return;
    constexpr double kRoundedDown = 1 - 1e-6;
    known_[static_cast<std::size_t>(four)][lane] = static_cast<float>((std::sqrt(distance2) + moved_) * kRoundedDown);
  }

  int rows() const noexcept { return rows_; }
  int fours() const noexcept { return (rows_ + 3) / 4; }
  /// [rt] Returns lower bounds of the squared distances [m^2] to four rows.
  Float4 distances(int four, const BoxProbe& probe) const noexcept {
    constexpr Float4 kZero{};
    const Float4 boxes = rowDistances(fours_[static_cast<std::size_t>(four)], probe);
    if constexpr (!Limits::kLearns) return boxes;
    const Float4 left = known_[static_cast<std::size_t>(four)] - static_cast<float>(moved_ * (1 + 1e-6));
    const Float4 known = (left > kZero ? left : kZero) * (left > kZero ? left : kZero) * kRowShare;
    return boxes > known ? boxes : known;
  }
  const Four& shapes(int four) const noexcept { return fours_[static_cast<std::size_t>(four)]; }
  ElementRow row(int four, int lane) const noexcept {
    return BoxTree::rowOf(children_[static_cast<std::size_t>(4 * four + lane)]);
  }

 private:
  struct Candidate {
    float bound2;
    std::int32_t row, child;
  };
  bool listElements(const BodyTree& body) noexcept;
  bool considerListed(const BodyTree& body, const BoxProbe& probe, double reach2, double& beyond2) noexcept;
  bool openBoxes(const BodyTree& body, const BoxProbe& probe, double reach2, double& beyond2) noexcept;
  bool collect(const BodyTree& body, const Eigen::Vector3d& p, double reach2, double& beyond2) noexcept;
  void add(const BodyTree& body, int first) noexcept;

  std::array<Four, Limits::kMostFours> fours_;
  std::array<Float4, Limits::kMostFours> known_{};  ///< [m] measured distance, plus the value of moved_ at that time
  std::array<std::int32_t, kMostRows> children_{};
  Eigen::Vector3d center_{0, 0, 0};
  double beyond_ = -1;
  double moved_ = 0;  ///< [m] distance moved by the probe since the rows were gathered
  int rows_ = 0;
  std::array<Candidate, Limits::kMostCandidates + 1> candidates_;
  int candidate_count_ = 0;
  std::array<Candidate, Limits::kMostListed + 16> listed_{};  ///< shapes in boxes of the tree that are within reach
  int listed_count_ = 0;
};

using NearElements = NearRows<ElementLimits>;
using NearTriangles = NearRows<TriangleLimits>;
extern template class NearRows<ElementLimits>;
extern template class NearRows<TriangleLimits>;

}  // namespace hapticd::brep
