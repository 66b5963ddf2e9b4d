// SPDX-License-Identifier: MIT
/// Traces one probe over a part. Outside the part the result is the nearest foot, in contact it is the foot of the held
/// contact. Each probe needs its own Tracer; all can share the Model.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "kernels/brep/contact/outside_bodies.hpp"
#include "kernels/brep/search/search.hpp"
#include "kernels/contact/contact_state.hpp"

namespace hapticd::brep {

/// What a tracer has counted since it was made.
struct TraceCounts {
  std::uint64_t nearest = 0;   ///< ticks whose foot is certainly the nearest
  std::uint64_t held = 0;      ///< ticks with a held contact whose foot is not, or not certainly, the nearest
  std::uint64_t degraded = 0;  ///< ticks whose search was not finished, or whose foot may not be the nearest
};

class Tracer {
 public:
  /// [main] Allocates all that stepping needs.
  explicit Tracer(const Model& model);

  /// [rt] Forgets everything.
  void reset() noexcept;
  /// [rt] Forgets where the probe was, so the next contact begins on the nearest face.
  void forgetContact() noexcept;
  /// [rt] Lets the probe pop through a shell: from now on the other side of the shell is felt.
  void popThrough() noexcept;
  /// [rt] Returns the foot of the probe p (model frame), which is held during a contact. If p is not finite, the status
  /// is kInvalid and the state stays unchanged.
  contact::Foot step(const Eigen::Vector3d& p, const contact::ContactRule& rule,
                     const SearchBudget& budget = {}) noexcept;
  /// [rt] Returns the nearest foot of all, with its outward normal, without regard to a held contact.
  contact::Foot nearest(const Eigen::Vector3d& p, const SearchBudget& budget = {}) noexcept;

  const TraceCounts& counts() const noexcept { return counts_; }
  const Model& model() const noexcept { return search_.model(); }

 private:
  class Faces;

  /// The face on which a contact is held, and the foot on this face.
  struct Held {
    std::uint32_t place = kNone;
    std::uint32_t face = kNone;  ///< index in the part; for meshes the triangle
    Hit hit;
  };
  /// Where a held face ends, and another body may go on.
  struct Joint {
    Eigen::Vector3d on;   ///< [m] where the held face would be over the probe
    Eigen::Vector3d way;  ///< [m] of the probe in this tick, along that face
    double depth;         ///< [m] of the probe below `on`: no step down is higher
    double up;            ///< [m] highest step up that is none
  };
  using Places = std::array<std::uint32_t, 8>;  ///< placements of bodies about a joint

  contact::Followed follow(double side, const Eigen::Vector3d& p, contact::Foot& foot) noexcept;
  contact::Followed followFace(double side, const Eigen::Vector3d& p) noexcept;
  bool goStraight(const Eigen::Vector3d& p) noexcept;
  contact::Followed followTriangles(double side, const Eigen::Vector3d& p) noexcept;
  contact::Followed slideOn(double side, const Eigen::Vector3d& p, Held& next) noexcept;
  void slideAround(std::uint32_t vertex, const Eigen::Vector3d& p, Held& next) noexcept;
  bool slideAside(double side, const Eigen::Vector3d& p, contact::Foot& foot) noexcept;
  contact::Followed slideOver(std::uint32_t edge, double t, double side, const Eigen::Vector3d& p, Held& next) noexcept;
  int bodiesAt(const Joint& joint, Places& places) const noexcept;
  Held faceAhead(std::uint32_t place, double side, const Joint& joint, const Eigen::Vector3d& at,
                 double& distance) noexcept;
  bool goOnTo(std::uint32_t place, double side, const Joint& joint, const Eigen::Vector3d& p,
              contact::Foot& foot) noexcept;
  bool goOnFlush(double side, const Eigen::Vector3d& p, contact::Foot& foot) noexcept;
  bool enter(const Eigen::Vector3d& from, const Eigen::Vector3d& p, contact::Sides sides, double& side) noexcept;
  void tryFace(std::uint32_t face, const Eigen::Vector3d& p, Held& next) noexcept;
  bool nearestOn(std::uint32_t face, const Eigen::Vector3d& p, Hit& hit) noexcept;
  contact::Foot nearestFelt(const Eigen::Vector3d& p) noexcept;
  bool preferDeepestAround(const Eigen::Vector3d& p, contact::Foot& foot) noexcept;
  /// Returns nearestFelt() of this tick's probe, which is found when it is first asked for.
  const contact::Foot& nearestOnce(const Eigen::Vector3d& p) noexcept;
  bool mayBeThroughGap(double way) const noexcept;
  Held heldAt(const Nearest& nearest) const noexcept;
  void count(const contact::Foot& foot) noexcept;

  Search search_;
  OutsideBodies outside_;
  contact::ContactState contact_;
  Held held_;
  Held nearest_;        ///< result of nearestFelt() in this tick
  contact::Foot felt_;  ///< result of nearestOnce() in this tick
  bool has_felt_ = false;
  std::uint32_t last_place_ = kNone;  ///< placement of nearest_ in the last tick; kNone if that was not certain
  SearchBudget budget_;
  Eigen::Vector3d last_p_{0, 0, 0};
  Eigen::Vector3d last_foot_{0, 0, 0};    ///< of the contact that is held, when it was last within a face
  Eigen::Vector3d last_normal_{0, 0, 0};  ///< there, toward the side that is felt; 0: unknown
  bool has_last_ = false;
  TraceCounts counts_;
};

/// [rt] Returns the face to which a hit belongs. For a hit on an edge, this is `before` if it is one of the edge's
/// faces, or else the first face of the edge. For a mesh, this is the triangle.
std::uint32_t faceOf(const Model& model, const Hit& hit, std::uint32_t before) noexcept;

/// [rt] Converts a hit to a foot in the model's frame, with the outward normal of the part. @param face result of
/// faceOf()
contact::Foot describe(const Model& model, std::uint32_t place, const Hit& hit, std::uint32_t face,
                       const Eigen::Vector3d& p) noexcept;

/// [rt] Returns the outward normal of the surface at a hit, of which describe() made `foot`. It differs from the normal
/// that is felt where the normals of a mesh are interpolated.
Eigen::Vector3d surfaceNormal(const Model& model, std::uint32_t place, const Hit& hit,
                              const contact::Foot& foot) noexcept;

}  // namespace hapticd::brep
