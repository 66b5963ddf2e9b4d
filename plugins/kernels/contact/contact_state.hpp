// SPDX-License-Identifier: MIT
/// Decides from tick to tick at which foot point a probe is felt. All kernels share this state machine.
///
/// Outside, the foot point is the nearest point of all faces. A contact begins on the face that the probe's path
/// crosses first. The contact is then held: its foot point is followed continuously over that face and its neighbours,
/// until the probe comes out or crosses a convex edge. The foot point is a proxy (Zilles & Salisbury 1995) on exact
/// geometry. If the solid is thick compared with the depth, the held foot point is also the nearest point. In a thin
/// wall it keeps the hand from passing through. If the path of the probe is unknown (a start inside, a jump, a lost
/// sample, a contact that ended at an edge), a contact begins on the nearest face.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kernels/contact/foot.hpp"

namespace hapticd::contact {

struct ContactRule {
  Sides sides = Sides::kFront;
  /// [m] Contact hysteresis: a held contact changes to another face if that face is nearer by more than this. With 0,
  /// no contact is held and the nearest face is always felt. With infinity, a contact is held until the probe comes
  /// out.
  double hysteresis = std::numeric_limits<double>::infinity();
  /// [m] A held contact that is deeper than this ends once the probe is certainly outside of the solid again, on
  /// another side: it went through. A shell is so thin that the probe is outside at any depth.
  double deepest = std::numeric_limits<double>::infinity();
};

/// The result of following a held foot to the probe's new position.
enum class Followed : std::uint8_t {
  kOn,        ///< the foot is on the surface; its depth shows whether the probe is still inside
  kReleased,  ///< the foot crossed a convex edge, and the probe is in front of the next face
  kLost       ///< the kernel no longer traces the surface
};

/// Where a path of the probe begins.
struct PathStart {
  Eigen::Vector3d point;
  double clearance;  ///< [m] no face is nearer to the point than this
};

/// The contact of one probe with one solid. `Faces` gives access to the kernel at the probe's position p of this tick.
/// It has these functions, all [rt]:
///   Followed follow(double side, Foot& foot)  follows the held foot to p, over edges by the rule of atEdge()
///   Foot nearest()                            returns the nearest foot of all faces; status kNearest if it is certain
///   bool enter(PathStart, Sides, double& side)  finds the first face that the path to p enters through a side that
///                                             is felt; holds this face and sets `side` to that side. On entry,
///                                             `side` is the side on which the start counts if it is almost on a face
///   void holdNearest()                        holds the nearest foot from now on
///   void release()                            ends the held contact
/// The feet from these functions have outward normals. This class turns them to the side that is felt.
class ContactState {
 public:
  /// [rt] Returns the foot of this tick, as felt from side().
  /// @param last position of the probe in the last tick [m]
  /// @param p position of the probe now [m]
  template <class Faces>
  Foot step(Faces& faces, const Eigen::Vector3d& last, const Eigen::Vector3d& p, const ContactRule& rule) noexcept;

  /// [rt] A shortcut for the most common tick. Call it before step(). The kernel must have followed, from the last
  /// tick, the held foot or, if none is held, the nearest foot of all; and this foot must be in the interior of its
  /// face. If the function returns true, the contact has not changed, and the result of the tick is this foot, as felt
  /// from side().
  /// @param height [m] height of the probe above the face, along its outward normal
  /// @param distance [m] distance from the probe to the face: that to the foot, less the error of the foot for a shell
  bool isUnchanged(double height, double distance, const Eigen::Vector3d& p, const ContactRule& rule) noexcept {
    const double out = side_ * height;
    if (phase_ == Phase::kHeld && rule.hysteresis > 0) return out < 0 && -out <= rule.deepest;
    if (!(rule.hysteresis > 0)) return rule.sides == Sides::kFront;
    const bool clear = phase_ == Phase::kOutside && (p - from_).squaredNorm() < clearance_ * clearance_;
    if (!clear || !(distance > kTouching) || (rule.sides != Sides::kBoth && !(out > 0))) return false;
    if (rule.sides == Sides::kBoth) side_ = height > 0 ? 1 : -1;
    from_ = p;
    clearance_ = kSure * distance;
    return true;
  }

  /// [rt] A shortcut like isUnchanged(), for a probe that was outside in the last tick and can have met only the face
  /// of its foot since then. If the function returns true, the probe is still outside, however near it is to the face.
  /// @param last position of the probe in the last tick [m]
  bool isPassing(double height, double distance, const Eigen::Vector3d& last, const Eigen::Vector3d& p,
                 const ContactRule& rule) noexcept {
    const double side = rule.sides == Sides::kBoth ? side_ : (rule.sides == Sides::kFront ? 1 : -1);
    if (phase_ != Phase::kOutside || from_ != last || !(side * height > kTouching)) return false;
    from_ = p;
    clearance_ = kSure * distance;
    return true;
  }

  bool held() const noexcept { return phase_ == Phase::kHeld; }  ///< [rt] true if a contact is held
  double side() const noexcept { return side_; }                 ///< [rt] +1 if the front is felt, -1 if the back
  /// [rt] Forgets where the probe came from, after a jump or a lost sample.
  void forget() noexcept { phase_ = Phase::kUnknown; }
  /// [rt] Call it if step() was skipped because the probe was certainly outside. The next path then begins at the
  /// probe's position in the tick before the next step().
  void pass() noexcept {
    if (phase_ != Phase::kUnknown) phase_ = Phase::kPassed;
  }
  /// [rt] Lets a probe at p pass through a shell: the probe is then on the other side.
  void popThrough(const Eigen::Vector3d& p) noexcept {
    side_ = -side_;
    beOutside(p, 0);
  }

 private:
  enum class Phase : std::uint8_t { kUnknown, kPassed, kOutside, kHeld };
  /// [m] if a face is nearer than this, rounding errors would decide on which side of the face the probe is
  static constexpr double kTouching = 1e-9;
  /// a path that is shorter than this share of the distance to the nearest face certainly meets no face
  static constexpr double kSure = 0.999;

  template <class Faces>
  bool stays(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule, Foot& foot) noexcept;
  template <class Faces>
  bool begins(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule, Foot& foot) noexcept;
  template <class Faces>
  bool isLeft(Faces& faces, const ContactRule& rule, Foot& foot) noexcept;
  template <class Faces>
  Foot atNearest(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule) noexcept;
  bool mayHaveCrossed(const Foot& nearest, const Eigen::Vector3d& p, const ContactRule& rule) const noexcept;
  Foot nearestAlways(const Foot& nearest, const Eigen::Vector3d& p, Sides sides) noexcept;
  void beOutside(const Eigen::Vector3d& p, double clearance) noexcept {
    phase_ = Phase::kOutside;
    from_ = p;
    clearance_ = clearance;
  }

  Phase phase_ = Phase::kUnknown;
  double side_ = 1;
  double clearance_ = 0;           ///< [m] no face is nearer to from_ than this
  Eigen::Vector3d from_{0, 0, 0};  ///< [m] last position of the probe outside
};

template <class Faces>
Foot ContactState::step(Faces& faces, const Eigen::Vector3d& last, const Eigen::Vector3d& p,
                        const ContactRule& rule) noexcept {
  if (rule.sides != Sides::kBoth) side_ = rule.sides == Sides::kFront ? 1 : -1;
  if (!(rule.hysteresis > 0)) {
    faces.release();
    return nearestAlways(faces.nearest(), p, rule.sides);
  }
  if (phase_ == Phase::kPassed) beOutside(last, 0);
  Foot foot;
  if (phase_ == Phase::kHeld && stays(faces, p, rule, foot)) return foot;
  if (phase_ == Phase::kOutside && begins(faces, p, rule, foot)) return foot;
  return atNearest(faces, p, rule);
}

/// Follows the held contact. If the contact has ended, sets the phase for the tests that come next and returns false.
template <class Faces>
bool ContactState::stays(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule, Foot& foot) noexcept {
  const Followed how = faces.follow(side_, foot);
  if (how == Followed::kOn) {
    foot = seenFrom(foot, side_);
    if (foot.depth > 0 && !isLeft(faces, rule, foot)) return true;
  }
  const bool came_out = how == Followed::kReleased || (how == Followed::kOn && !(foot.depth > 0));
  // If the foot is not certain, the probe may not have come out: what it then enters, it enters from the shell.
  const bool unsure = rule.sides == Sides::kBoth && how == Followed::kOn && foot.status == FootStatus::kDegraded;
  beOutside(unsure ? foot.point : p, 0);
  if (!came_out) phase_ = Phase::kUnknown;
  faces.release();
  return false;
}

/// True if another face is nearer than the held foot by more than the hysteresis, or if the probe went through. Sets
/// the status of the held foot to kHeld if that foot is not the nearest.
template <class Faces>
bool ContactState::isLeft(Faces& faces, const ContactRule& rule, Foot& foot) noexcept {
  constexpr double kSame = 1e-9;  // [m] distances that differ by less count as equal
  const Foot nearest = faces.nearest();
  const bool is_nearest = nearest.status == FootStatus::kNearest && nearest.distance >= foot.distance - kSame;
  if (foot.status == FootStatus::kNearest && !is_nearest) foot.status = FootStatus::kHeld;
  const bool outside = rule.sides == Sides::kBoth || !(seenFrom(nearest, side_).depth > 0);
  if (foot.depth > rule.deepest && nearest.status == FootStatus::kNearest && outside) return true;
  return found(nearest) && nearest.distance < foot.distance - rule.hysteresis;
}

/// Makes the swept test: returns true if the path from the last position outside leads into a face.
template <class Faces>
bool ContactState::begins(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule, Foot& foot) noexcept {
  const double way2 = (p - from_).squaredNorm();
  double side = side_;
  if (!(way2 > 0) || way2 < clearance_ * clearance_ || !faces.enter({from_, clearance_}, rule.sides, side))
    return false;
  if (faces.follow(side, foot) == Followed::kOn) {
    foot = seenFrom(foot, side);
    if (foot.depth > 0 && !isLeft(faces, rule, foot)) {
      phase_ = Phase::kHeld;
      side_ = side;
      foot.begins = true;
      return true;
    }
  }
  faces.release();  // the probe has come out again in the same tick
  return false;
}

/// True if the probe may have crossed a shell unseen, since the foot is not certain: it may be seen from a wrong side.
/// The next certain foot decides, with the whole path since from_.
inline bool ContactState::mayHaveCrossed(const Foot& nearest, const Eigen::Vector3d& p,
                                         const ContactRule& rule) const noexcept {
  if (rule.sides != Sides::kBoth || nearest.status != FootStatus::kDegraded) return false;
  return side_ * nearest.behind > 0 || atLeast(nearest) <= (p - from_).norm();
}

/// Returns the nearest foot if no contact is held. If the probe is inside, a contact may begin there.
template <class Faces>
Foot ContactState::atNearest(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule) noexcept {
  Foot nearest = faces.nearest();
  if (!found(nearest)) {
    phase_ = Phase::kUnknown;
    return nearest;
  }
  const bool touching =
      phase_ == Phase::kOutside && (!(nearest.distance > kTouching) || mayHaveCrossed(nearest, p, rule));
  if (rule.sides == Sides::kBoth && !touching) side_ = nearest.behind > 0 ? -1 : 1;
  Foot foot = seenFrom(nearest, side_);
  if (rule.sides != Sides::kBoth && foot.depth > 0) {
    phase_ = Phase::kUnknown;
    // the foot is felt, but it is not certain to be the nearest, so it is not held
    if (foot.status != FootStatus::kNearest) return foot;
    faces.holdNearest();
    phase_ = Phase::kHeld;
    foot.begins = true;
    return foot;
  }
  foot.depth = -foot.distance;
  // A solid feels a probe that went into it, whether the way in was seen or not.
  const double certain = rule.sides == Sides::kBoth ? atLeast(foot) : foot.distance;
  if (!touching) beOutside(p, foot.status == FootStatus::kNearest ? kSure * certain : 0);
  return foot;
}

/// Returns the foot if there is no contact hysteresis. A shell is felt from the side from which the probe came, until
/// the probe has gone round a free edge.
inline Foot ContactState::nearestAlways(const Foot& nearest, const Eigen::Vector3d& p, Sides sides) noexcept {
  if (!found(nearest)) {
    phase_ = Phase::kUnknown;
    return nearest;
  }
  const bool known = phase_ != Phase::kUnknown && !(nearest.aside > std::abs(nearest.behind));
  if (sides == Sides::kBoth && !known) side_ = nearest.behind > 0 ? -1 : 1;
  beOutside(p, 0);
  return seenFrom(nearest, side_);
}

}  // namespace hapticd::contact
