// SPDX-License-Identifier: MIT
/// Shapes of several sizes with one mistake each, for `hapticd plugin check`; and the same without it.
#include <cmath>

#include "hapticd/shape.hpp"

namespace {

enum class Mistake {
  kNone,
  kPulls,       ///< the force has the wrong sign
  kInnerPulls,  ///< the same, on the side of the ring that faces its axis alone
  kStep,        ///< 2 N from depth 0 on
  kSmallJump,   ///< the same, where a jump of 0.2 N is claimed
  kNoContact,   ///< HSP_OUT_CONTACT is forgotten
  kNoTraced,    ///< HSP_OUT_TRACED is forgotten
  kNoClaim,     ///< no stiffness is claimed
  kSmallClaim,  ///< a quarter of it
  kSilent,      ///< it answers nothing at all
  kNeverDeep,   ///< its depth is never above 0
  kLeftPulls,   ///< forces are reversed on the side to -x alone
  kUnderPulls,  ///< and on the under side alone
  kDamps,       ///< none: it damps, and pushes only
  kDrives,      ///< the damper has the wrong sign
  kDamperPulls  ///< the damper pulls on a quick way out, although it reports to push only
};

struct Point {
  double x, y, z;
};

/// Depth, outward normal; the foot follows.
struct Depth {
  double depth;
  Point normal;
};

Depth ball(const Point& p, double radius) noexcept {
  const double d = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z) + 1e-300;
  return {radius - d, {p.x / d, p.y / d, p.z / d}};
}

Depth ring(const Point& p, double radius, double tube) noexcept {
  const double around = std::hypot(p.x, p.z) + 1e-300, part = radius / around;
  const Point axis{p.x * (1 - part), p.y, p.z * (1 - part)};
  return ball(axis, tube);
}

/// A box, which has six sides; its edges are sharp.
Depth box(const Point& p, const Point& half) noexcept {
  const double at[3] = {p.x, p.y, p.z}, most[3] = {half.x, half.y, half.z};
  double normal[3] = {0, 0, 0}, outside = 0, nearest = -1e300;
  int side = 0;
  for (int i = 0; i < 3; ++i) {
    const double over = std::fabs(at[i]) - most[i];
    if (over > nearest) nearest = over, side = i;
    if (over > 0) normal[i] = std::copysign(over, at[i]), outside += over * over;
  }
  if (!(outside > 0)) {
    normal[side] = std::copysign(1, at[side]);
    return {-nearest, {normal[0], normal[1], normal[2]}};
  }
  const double far = std::sqrt(outside);
  return {-far, {normal[0] / far, normal[1] / far, normal[2] / far}};
}

Depth ground(const Point& p) noexcept {
  return {-p.y, {0, 1, 0}};
}

template <class Derived, Mistake kMistake>
struct Touched : hapticd::Shape {
  static constexpr bool kDamper =
      kMistake == Mistake::kDamps || kMistake == Mistake::kDrives || kMistake == Mistake::kDamperPulls;
  double stiffness = 0;
  static constexpr auto fields() {
    return std::array{hapticd::Fields<Derived>::real("stiffness", &Derived::stiffness, "N/m", 0, 5000, 500, "Spring.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    if (kMistake != Mistake::kNoClaim) report.max_stiffness = stiffness * (kMistake == Mistake::kSmallClaim ? 0.25 : 1);
    if (kMistake == Mistake::kSmallJump) hapticd::reportJumps(report, 0.2);
    if (kDamper) report.flags |= HSP_R_VELOCITY;
    if (kDamper && kMistake != Mistake::kDrives) report.flags |= HSP_R_PUSHES;
  }
  /// A spring, and a damper that grows with the depth. `outward` is the velocity along the normal.
  double damped(double depth, double outward) const {
    constexpr double kDamping = 5, kWhole = 1e-3;  // [N s/m]; [m] depth from which on it is the whole damper
    const double brake = -kDamping * std::fmin(depth / kWhole, 1) * outward;
    const double force = stiffness * depth + (kMistake == Mistake::kDrives ? -brake : brake);
    return kMistake == Mistake::kDamperPulls ? force : std::fmax(force, 0);
  }
  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    if ((in.flags & HSP_IN_INVALID) != 0 || kMistake == Mistake::kSilent) return HSP_OK;
    const Point p{in.position[0], in.position[1], in.position[2]};
    Depth at = Derived::depthAt(p);
    const double n[3] = {at.normal.x, at.normal.y, at.normal.z};
    if (kMistake == Mistake::kNeverDeep) at.depth = -std::fabs(at.depth);
    if (kMistake != Mistake::kNoTraced) out.flags = HSP_OUT_TRACED;
    out.depth_m = at.depth;
    double force = kMistake == Mistake::kStep || kMistake == Mistake::kSmallJump ? 2 : stiffness * at.depth;
    if (kDamper) force = damped(at.depth, in.velocity[0] * n[0] + in.velocity[1] * n[1] + in.velocity[2] * n[2]);
    const bool inner = std::hypot(p.x, p.z) < 0.04;
    if (kMistake == Mistake::kPulls || (kMistake == Mistake::kInnerPulls && inner) ||
        (kMistake == Mistake::kLeftPulls && n[0] < -0.9) || (kMistake == Mistake::kUnderPulls && n[1] < -0.9))
      force = -force;
    for (int i = 0; i < 3; ++i) {
      out.normal[i] = n[i];
      out.point[i] = in.position[i] + at.depth * n[i];
      out.force[i] = at.depth > 0 ? force * n[i] : 0;
    }
    if (at.depth > 0 && kMistake != Mistake::kNoContact) out.flags |= HSP_OUT_CONTACT;
    return HSP_OK;
  }
};

#define SHAPE(NAME, TYPE, MISTAKE, DEPTH)                                                                        \
  struct TYPE : Touched<TYPE, Mistake::MISTAKE> {                                                                \
    static constexpr hapticd::ShapeInfo kInfo{"org.example.shape." NAME, NAME, "1.0.0", "MIT", "To be tested."}; \
    static Depth depthAt(const Point& p) noexcept { return DEPTH; }                                              \
  };

SHAPE("ring_right", RingRight, kNone, ring(p, 0.04, 0.015))
SHAPE("ring_pulls", RingPulls, kPulls, ring(p, 0.04, 0.015))
SHAPE("ring_pulls_inside", RingPullsInside, kInnerPulls, ring(p, 0.04, 0.015))
SHAPE("large_ring_pulls", LargeRingPulls, kPulls, ring(p, 0.1, 0.02))
SHAPE("ball_right", BallRight, kNone, ball(p, 0.005))
SHAPE("ball_pulls", BallPulls, kPulls, ball(p, 0.005))
SHAPE("middle_ball_pulls", MiddleBallPulls, kPulls, ball(p, 0.1))
SHAPE("large_ball_pulls", LargeBallPulls, kPulls, ball(p, 0.4))
SHAPE("far_ball_pulls", FarBallPulls, kPulls, ball({p.x - 0.3, p.y, p.z + 0.2}, 0.03))
SHAPE("box_right", BoxRight, kNone, box(p, {0.06, 0.03, 0.04}))
SHAPE("box_left_pulls", BoxLeftPulls, kLeftPulls, box(p, {0.06, 0.03, 0.04}))
SHAPE("box_under_pulls", BoxUnderPulls, kUnderPulls, box({p.x - 0.1, p.y, p.z}, {0.06, 0.03, 0.04}))
SHAPE("floor_right", FloorRight, kNone, ground(p))
SHAPE("floor_pulls", FloorPulls, kPulls, ground(p))
SHAPE("ring_steps", RingSteps, kStep, ring(p, 0.04, 0.015))
SHAPE("ring_steps_far", RingStepsFar, kSmallJump, ring(p, 0.04, 0.015))
SHAPE("ring_no_contact", RingNoContact, kNoContact, ring(p, 0.04, 0.015))
SHAPE("ring_no_traced", RingNoTraced, kNoTraced, ring(p, 0.04, 0.015))
SHAPE("ring_no_claim", RingNoClaim, kNoClaim, ring(p, 0.04, 0.015))
SHAPE("ring_small_claim", RingSmallClaim, kSmallClaim, ring(p, 0.04, 0.015))
SHAPE("ring_silent", RingSilent, kSilent, ring(p, 0.04, 0.015))
SHAPE("ring_never_deep", RingNeverDeep, kNeverDeep, ring(p, 0.04, 0.015))
SHAPE("box_damps", BoxDamps, kDamps, box(p, {0.06, 0.03, 0.04}))
SHAPE("box_drives", BoxDrives, kDrives, box(p, {0.06, 0.03, 0.04}))
SHAPE("ring_damps", RingDamps, kDamps, ring(p, 0.04, 0.015))
SHAPE("ring_damper_pulls", RingDamperPulls, kDamperPulls, ring(p, 0.04, 0.015))

struct BadId : RingRight {
  static constexpr hapticd::ShapeInfo kInfo{"org.example.shape.bad_id", "bad_id", "1.0.0", "MIT", "To be tested."};
  static constexpr auto fields() {
    return std::array{
        hapticd::Fields<BadId>::real("ring stiffness", &BadId::stiffness, "N/m", 0, 5000, 500, "Spring.")};
  }
};

}  // namespace

HAPTICD_SHAPES(BadId, RingRight, RingPulls, RingPullsInside, LargeRingPulls, BallRight, BallPulls, MiddleBallPulls,
               LargeBallPulls, FarBallPulls, BoxRight, BoxLeftPulls, BoxUnderPulls, FloorRight, FloorPulls, RingSteps,
               RingStepsFar, RingNoContact, RingNoTraced, RingNoClaim, RingSmallClaim, RingSilent, RingNeverDeep,
               BoxDamps, BoxDrives, RingDamps, RingDamperPulls)
