// SPDX-License-Identifier: MIT
/// Traces one probe over a part: the nearest foot outside, the held one inside. One Tracer a probe; the Model is
/// shared.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "kernels/brep/search.hpp"
#include "kernels/contact/contact_state.hpp"

namespace hapticd::brep {

/// What a tracer has counted since it was made or its counts were cleared.
struct TraceCounts {
  std::uint64_t nearest = 0;   ///< ticks whose foot is proved the nearest
  std::uint64_t held = 0;      ///< ticks with a held contact whose foot is not the nearest, or may not be
  std::uint64_t degraded = 0;  ///< ticks whose search was not finished, or cannot prove its foot
};

class Tracer {
 public:
  /// [main] Allocates all that stepping needs.
  explicit Tracer(const Model& model);

  /// [rt] Forgets everything.
  void reset() noexcept;
  /// [rt] Forgets where the probe was: a contact begins on the nearest face.
  void forgetContact() noexcept;
  /// [rt] A shell gives way: from now on its other side is felt.
  void popThrough() noexcept;
  /// [rt] Foot of probe p (model frame) as it is felt. A probe that is no finite position leaves everything unchanged.
  contact::Foot step(const Eigen::Vector3d& p, const contact::ContactRule& rule,
                     const SearchBudget& budget = {}) noexcept;
  /// [rt] The nearest foot of all, with its outward normal; no contact is held.
  contact::Foot nearest(const Eigen::Vector3d& p, const SearchBudget& budget = {}) noexcept;

  const TraceCounts& counts() const noexcept { return counts_; }
  const Model& model() const noexcept { return search_.model(); }

 private:
  class Faces;

  /// The face that a held contact is on, and its foot there.
  struct Held {
    std::uint32_t place = kNone;
    std::uint32_t face = kNone;  ///< in the part; of meshes: the triangle
    Hit hit;
  };

  contact::Followed follow(double side, const Eigen::Vector3d& p, contact::Foot& foot) noexcept;
  contact::Followed followFace(double side, const Eigen::Vector3d& p) noexcept;
  contact::Followed followTriangles(double side, const Eigen::Vector3d& p) noexcept;
  contact::Followed slideOver(std::uint32_t edge, double t, double side, const Eigen::Vector3d& p, Held& next) noexcept;
  bool enter(const Eigen::Vector3d& from, const Eigen::Vector3d& p, contact::Sides sides, double& side) noexcept;
  contact::Foot nearestFelt(const Eigen::Vector3d& p) noexcept;
  Held heldAt(const Nearest& nearest) const noexcept;
  void count(const contact::Foot& foot) noexcept;

  Search search_;
  contact::ContactState contact_;
  Held held_;
  Held nearest_;  ///< result of nearestFelt() in this tick
  SearchBudget budget_;
  Eigen::Vector3d last_p_{0, 0, 0};
  bool has_last_ = false;
  TraceCounts counts_;
};

/// [rt] The face that a hit belongs to: of an edge, `before` if that is one of its faces, else the first of them. Of a
/// mesh: the triangle.
std::uint32_t faceOf(const Model& model, const Hit& hit, std::uint32_t before) noexcept;

/// [rt] A hit as a foot in the model's frame, seen by the outward normal of the part. `face`: see faceOf().
contact::Foot describe(const Model& model, std::uint32_t place, const Hit& hit, std::uint32_t face,
                       const Eigen::Vector3d& p) noexcept;

}  // namespace hapticd::brep
