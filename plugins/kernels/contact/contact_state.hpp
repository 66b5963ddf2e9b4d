// SPDX-License-Identifier: MIT
/// Contact truth: which foot a probe is felt by, from tick to tick. A small state machine that the kernels share.
///
/// Outside, the foot is the nearest point of all faces. A contact begins on the face that the probe's way crosses first
/// and is held: its foot is followed continuously over that face and the next ones, a proxy (Zilles & Salisbury 1995)
/// on exact geometry, until the probe comes out or goes over a convex edge. In a solid thicker than the press that is
/// the nearest point as well; in a thin wall it is what keeps the hand out. Where nothing is known of the way (a start
/// inside, a jump, a lost sample, a contact that ended at an edge), a contact begins on the nearest face.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kernels/contact/foot.hpp"

namespace hapticd::contact {

struct ContactRule {
  Sides sides = Sides::kFront;
  /// [m] Contact hysteresis: a held contact is left for a face that is nearer by more than this. 0: the nearest face
  /// always, nothing is held. Infinite: held until the probe comes out.
  double hysteresis = std::numeric_limits<double>::infinity();
};

/// What became of a held foot that was followed to the probe.
enum class Followed : std::uint8_t {
  kOn,        ///< it is on the surface; its depth shows whether the probe is still inside
  kReleased,  ///< it crossed a convex edge, and the probe is in front of the next face
  kLost       ///< the kernel no longer follows it
};

/// The contact of one probe with one solid. `Faces` is the kernel at the probe p of this tick. It has, all [rt]:
///   Followed follow(double side, Foot& foot)  the held foot, followed to p over edges as atEdge() says
///   Foot nearest()                            the nearest foot of all faces: kNearest where that is proved
///   bool enter(from, Sides, double& side)     looks for the first face that the way from `from` to p meets from a side
///                                             that is felt; it is held from there on, and `side` is that side. In: the
///                                             side on which `from` is of a face that it is almost on
///   void holdNearest()                        the nearest foot is held from now on
///   void release()                            nothing is held
/// with feet as the outward normal sees them; this class turns them to the side that is felt.
class ContactState {
 public:
  /// [rt] The foot of this tick, seen from the side that is felt. @param last the probe of the last tick
  template <class Faces>
  Foot step(Faces& faces, const Eigen::Vector3d& last, const Eigen::Vector3d& p, const ContactRule& rule) noexcept;

  /// [rt] The common tick, asked before step(): the kernel has the nearest foot of all, in the inside of its face,
  /// followed there from the last tick (the held one, if one is held). True if nothing else has changed: then this foot
  /// is the answer, seen from side(). @param height [m] of the probe over the face by its outward normal
  bool goesOn(double height, double distance, const Eigen::Vector3d& p, const ContactRule& rule) noexcept {
    const double out = side_ * height;
    if (phase_ == Phase::kHeld && rule.hysteresis > 0) return out < 0;
    if (!(rule.hysteresis > 0)) return rule.sides == Sides::kFront;
    const bool clear = phase_ == Phase::kOutside && (p - from_).squaredNorm() < clearance_ * clearance_;
    if (!clear || !(distance > kTouching) || (rule.sides != Sides::kBoth && !(out > 0))) return false;
    if (rule.sides == Sides::kBoth) side_ = height > 0 ? 1 : -1;
    from_ = p;
    clearance_ = kSure * distance;
    return true;
  }

  /// [rt] The same if since the last tick the probe may have met only the face of its foot, and was outside and nearest
  /// to that face then: it has passed by, however near. @param last the probe of the last tick
  bool passesBy(double height, double distance, const Eigen::Vector3d& last, const Eigen::Vector3d& p,
                const ContactRule& rule) noexcept {
    const double side = rule.sides == Sides::kBoth ? side_ : (rule.sides == Sides::kFront ? 1 : -1);
    if (phase_ != Phase::kOutside || from_ != last || !(side * height > kTouching)) return false;
    from_ = p;
    clearance_ = kSure * distance;
    return true;
  }

  bool held() const noexcept { return phase_ == Phase::kHeld; }  ///< [rt]
  double side() const noexcept { return side_; }                 ///< [rt] +1: the front is felt, -1: the back
  /// [rt] It is no longer known where the probe came from: a jump, or a lost sample.
  void forget() noexcept { phase_ = Phase::kUnknown; }
  /// [rt] step() was skipped because the probe was surely outside: the next way begins at the probe of the last tick.
  void pass() noexcept {
    if (phase_ != Phase::kUnknown) phase_ = Phase::kPassed;
  }
  /// [rt] A shell gives way: the probe, at p, is now on its other side.
  void popThrough(const Eigen::Vector3d& p) noexcept {
    side_ = -side_;
    beOutside(p, 0);
  }

 private:
  enum class Phase : std::uint8_t { kUnknown, kPassed, kOutside, kHeld };
  static constexpr double kTouching = 1e-9;  ///< [m] so near to a face, rounding decides the probe's side
  static constexpr double kSure = 0.999;     ///< share of a distance: so short a way meets no face

  template <class Faces>
  bool stays(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule, Foot& foot) noexcept;
  template <class Faces>
  bool begins(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule, Foot& foot) noexcept;
  template <class Faces>
  bool isLeft(Faces& faces, const ContactRule& rule, Foot& foot) noexcept;
  template <class Faces>
  Foot atNearest(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule) noexcept;
  Foot nearestAlways(const Foot& nearest, const Eigen::Vector3d& p, Sides sides) noexcept;
  void beOutside(const Eigen::Vector3d& p, double clearance) noexcept {
    phase_ = Phase::kOutside;
    from_ = p;
    clearance_ = clearance;
  }

  Phase phase_ = Phase::kUnknown;
  double side_ = 1;
  double clearance_ = 0;           ///< [m] no face is nearer to from_
  Eigen::Vector3d from_{0, 0, 0};  ///< [m] where the probe was last outside
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

/// Follows the held contact. False if it has ended; then what is known of the way is noted.
template <class Faces>
bool ContactState::stays(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule, Foot& foot) noexcept {
  const Followed how = faces.follow(side_, foot);
  if (how == Followed::kOn) {
    foot = seenFrom(foot, side_);
    if (foot.depth > 0 && !isLeft(faces, rule, foot)) return true;
  }
  const bool came_out = how == Followed::kReleased || (how == Followed::kOn && !(foot.depth > 0));
  beOutside(p, 0);
  if (!came_out) phase_ = Phase::kUnknown;
  faces.release();
  return false;
}

/// True if another face is nearer by more than the hysteresis. Notes in the held foot whether it is the nearest.
template <class Faces>
bool ContactState::isLeft(Faces& faces, const ContactRule& rule, Foot& foot) noexcept {
  constexpr double kSame = 1e-9;  // [m] of two distances
  const Foot nearest = faces.nearest();
  const bool is_nearest = nearest.status == FootStatus::kNearest && nearest.distance >= foot.distance - kSame;
  if (foot.status == FootStatus::kNearest && !is_nearest) foot.status = FootStatus::kHeld;
  return found(nearest) && nearest.distance < foot.distance - rule.hysteresis;
}

/// The swept test: whether the way since the probe was outside leads into a face.
template <class Faces>
bool ContactState::begins(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule, Foot& foot) noexcept {
  const double way2 = (p - from_).squaredNorm();
  double side = side_;
  if (!(way2 > 0) || way2 < clearance_ * clearance_ || !faces.enter(from_, rule.sides, side)) return false;
  if (faces.follow(side, foot) == Followed::kOn) {
    foot = seenFrom(foot, side);
    if (foot.depth > 0 && !isLeft(faces, rule, foot)) {
      phase_ = Phase::kHeld;
      side_ = side;
      foot.begins = true;
      return true;
    }
  }
  faces.release();  // it has come out again in the same tick
  return false;
}

/// No contact is held: the nearest foot, and a contact there if the probe is inside after all.
template <class Faces>
Foot ContactState::atNearest(Faces& faces, const Eigen::Vector3d& p, const ContactRule& rule) noexcept {
  const Foot nearest = faces.nearest();
  if (!found(nearest)) {
    phase_ = Phase::kUnknown;
    return nearest;
  }
  const bool touching = phase_ == Phase::kOutside && !(nearest.distance > kTouching);
  if (rule.sides == Sides::kBoth && !touching) side_ = nearest.behind > 0 ? -1 : 1;
  Foot foot = seenFrom(nearest, side_);
  if (rule.sides != Sides::kBoth && foot.depth > 0) {
    phase_ = Phase::kUnknown;
    if (foot.status != FootStatus::kNearest) return foot;  // it is felt, but a foot that is not proved is not held
    faces.holdNearest();
    phase_ = Phase::kHeld;
    foot.begins = true;
    return foot;
  }
  foot.depth = -foot.distance;
  if (!touching) beOutside(p, foot.status == FootStatus::kNearest ? kSure * foot.distance : 0);
  return foot;
}

/// Without a hysteresis. A shell keeps the side that the probe came from until the probe has gone round a free edge.
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
