// SPDX-License-Identifier: MIT
/// Rings whose force, foot, normal or memory goes astray by a little, as a cold reader built them and `hapticd plugin
/// check` passed them; and honest ones that rub, damp, click or pull on purpose.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "hapticd/shape.hpp"

namespace {

enum class Stray {
  kNone,
  kSwirls,         ///< a force along the ring, a part of that which pushes; reports to push only
  kSwirlsUnsaid,   ///< the same, without that report
  kSwirlsRound,    ///< round the tube, without that report
  kSwirlsALittle,  ///< three parts in a hundred, without that report
  kRubs,           ///< friction: honest
  kDrags,          ///< along its velocity: honest
  kFootOff,        ///< 0.3 mm outside of the surface
  kFootSlipped,    ///< 2 mm aside
  kNormalTilted,   ///< by 20 degrees, of unit length
  kDepthShort,     ///< outside, four fifths of the distance
  kPullsOutside,   ///< reports to push only
  kMagnet,         ///< the same, without that report: honest
  kAllocatesDeep,  ///< below 3 mm
  kSnaps,          ///< once for each touch, and forgets it where the probe jumps: honest
  kSnapsOn,        ///< and does not forget it
  kToldWrong,      ///< contact.stiffness of the wrong sign
  kOverruns        ///< writes behind its own record
};

struct Vector {
  double x, y, z;
  friend Vector operator*(double s, const Vector& v) { return {s * v.x, s * v.y, s * v.z}; }
  friend Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  void to(double* out) const { out[0] = x, out[1] = y, out[2] = z; }
};

double dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

constexpr double kRadius = 0.04, kTube = 0.012, kSpring = 500, kClick = 0.3, kClickDepth = 1e-3;

/// The ring about y, seen from a probe.
struct Near {
  Vector normal, along, round;  ///< outward; along the ring; round its tube
  Vector foot;
  double depth;
};

Near nearest(const double* p, double radius) {
  const double rho = std::hypot(p[0], p[2]) + 1e-300, ux = p[0] / rho, uz = p[2] / rho;
  const double a = rho - radius, b = p[1], d = std::hypot(a, b) + 1e-300;
  Near near;
  near.normal = {a / d * ux, b / d, a / d * uz};
  near.along = {-uz, 0, ux};
  near.round = {-b / d * ux, a / d, -b / d * uz};
  near.foot = Vector{radius * ux, 0, radius * uz} + kTube * near.normal;
  near.depth = kTube - d;
  return near;
}

/// Of each probe: what it has felt, and where friction holds it.
struct Felt {
  bool clicked = false, holds = false;
  Vector at = {0, 0, 0};
};

template <class Derived, Stray kStray>
struct Ring : hapticd::Shape {
  double nothing = 0;
  std::vector<Felt> felt;
  std::vector<double> kept;
  static constexpr auto fields() {
    return std::array{hapticd::Fields<Derived>::real("nothing", &Derived::nothing, "", 0, 1, 0, "None.")};
  }
  static constexpr bool is(Stray stray) { return kStray == stray; }
  void activate(const hsp_activation& activation, hsp_report& report) {
    constexpr bool kSnapping = kStray == Stray::kSnaps || kStray == Stray::kSnapsOn;
    constexpr bool kUnsaid = kStray == Stray::kSwirlsUnsaid || kStray == Stray::kSwirlsRound ||
                             kStray == Stray::kSwirlsALittle || kStray == Stray::kRubs || kStray == Stray::kDrags ||
                             kStray == Stray::kMagnet;
    felt.assign(activation.max_probes, Felt{});
    report.max_stiffness = kSnapping ? kSpring + kClick / kClickDepth : kSpring;
    report.size_m = 2 * (kRadius + kTube);
    if (!kUnsaid) report.flags |= HSP_R_PUSHES;
    if (is(Stray::kDrags)) report.flags |= HSP_R_VELOCITY;
    if (kSnapping || is(Stray::kMagnet) || is(Stray::kPullsOutside)) hapticd::reportJumps(report, kClick);
  }
  void reset() noexcept HSP_RT { std::fill(felt.begin(), felt.end(), Felt{}); }

  /// Along the surface; `push` is the force outward.
  Vector sideways(Felt& mine, const Near& near, const hsp_probe& in, double push) {
    const Vector velocity{in.velocity[0], in.velocity[1], in.velocity[2]};
    if (is(Stray::kSwirls) || is(Stray::kSwirlsUnsaid)) return 0.2 * push * near.along;
    if (is(Stray::kSwirlsRound)) return 0.2 * push * near.round;
    if (is(Stray::kSwirlsALittle)) return 0.03 * push * near.along;
    if (is(Stray::kDrags)) return -2.0 * velocity;
    return is(Stray::kRubs) ? rub(mine, near, in, push) : Vector{0, 0, 0};
  }

  /// The tip hangs on a spring from where it is held, with at most half of the push; then the hold slides along.
  static Vector rub(Felt& mine, const Near& near, const hsp_probe& in, double push) {
    const Vector p{in.position[0], in.position[1], in.position[2]};
    if (!mine.holds) mine.at = p;
    mine.holds = true;
    const Vector way = p + -1.0 * mine.at, along = way + -dot(way, near.normal) * near.normal;
    const double pull = kSpring * std::sqrt(dot(along, along)), most = 0.5 * push;
    const double part = pull > most ? most / pull : 1;
    if (part < 1) mine.at = p + -part * along;
    return -kSpring * part * along;
  }

  double push(Felt& mine, double depth) {
    if (is(Stray::kAllocatesDeep) && depth > 3e-3) kept.assign(kept.size() + 1, depth);
    if (depth > kClickDepth) mine.clicked = true;
    const bool snaps = is(Stray::kSnaps) || is(Stray::kSnapsOn);
    return kSpring * depth + (snaps && !mine.clicked ? kClick * depth / kClickDepth : 0);
  }

  void misplace(const Near& near, hsp_contact& out) {
    Near other = near;
    if (is(Stray::kFootOff)) other.foot = near.foot + 3e-4 * near.normal;
    if (is(Stray::kFootSlipped)) other.foot = near.foot + 2e-3 * near.along;
    if (is(Stray::kNormalTilted)) other.normal = std::cos(0.35) * near.normal + std::sin(0.35) * near.round;
    other.foot.to(out.point), other.normal.to(out.normal);
  }

  hsp_status touch(const hsp_probe& in, const hsp_step& step, hsp_contact& out) noexcept HSP_RT {
    const auto bytes = reinterpret_cast<const char*>(&in) - reinterpret_cast<const char*>(step.in);
    Felt& mine = felt[static_cast<size_t>(bytes) / step.in_stride];
    const bool forgets = (in.flags & HSP_IN_INVALID) != 0 || ((in.flags & HSP_IN_JUMP) != 0 && !is(Stray::kSnapsOn));
    if (forgets) mine = Felt{};
    if ((in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    const Near near = nearest(in.position, kRadius);
    out.flags = HSP_OUT_TRACED;
    out.depth_m = is(Stray::kDepthShort) ? std::max(0.8 * near.depth, near.depth) : near.depth;
    misplace(near, out);
    if (near.depth <= 0) {
      mine = Felt{};
      const bool pulls = is(Stray::kPullsOutside) || is(Stray::kMagnet);
      if (pulls && near.depth > -1e-3) (-0.2 * near.normal).to(out.force);
      return HSP_OK;
    }
    out.flags |= HSP_OUT_CONTACT;
    out.stiffness = is(Stray::kToldWrong) ? -kSpring : kSpring;
    const double force = push(mine, near.depth);
    (force * near.normal + sideways(mine, near, in, force)).to(out.force);
    if (is(Stray::kOverruns)) (&out)[1].force[0] = 1e3;
    return HSP_OK;
  }
};

#define SHAPE(NAME, TYPE, STRAY)                                                                                 \
  struct TYPE : Ring<TYPE, Stray::STRAY> {                                                                       \
    static constexpr hapticd::ShapeInfo kInfo{"org.example.shape." NAME, NAME, "1.0.0", "MIT", "To be tested."}; \
  };

SHAPE("straight", Straight, kNone)
SHAPE("swirls", Swirls, kSwirls)
SHAPE("swirls_unsaid", SwirlsUnsaid, kSwirlsUnsaid)
SHAPE("swirls_round", SwirlsRound, kSwirlsRound)
SHAPE("swirls_a_little", SwirlsALittle, kSwirlsALittle)
SHAPE("rubs", Rubs, kRubs)
SHAPE("drags", Drags, kDrags)
SHAPE("foot_off", FootOff, kFootOff)
SHAPE("foot_slipped", FootSlipped, kFootSlipped)
SHAPE("normal_tilted", NormalTilted, kNormalTilted)
SHAPE("depth_short", DepthShort, kDepthShort)
SHAPE("pulls_outside", PullsOutside, kPullsOutside)
SHAPE("magnet", Magnet, kMagnet)
SHAPE("allocates_deep", AllocatesDeep, kAllocatesDeep)
SHAPE("snaps", Snaps, kSnaps)
SHAPE("snaps_on", SnapsOn, kSnapsOn)
SHAPE("told_wrong", ToldWrong, kToldWrong)
SHAPE("overruns", Overruns, kOverruns)

}  // namespace

HAPTICD_SHAPES(Straight, Swirls, SwirlsUnsaid, SwirlsRound, SwirlsALittle, Rubs, Drags, FootOff, FootSlipped,
               NormalTilted, DepthShort, PullsOutside, Magnet, AllocatesDeep, Snaps, SnapsOn, ToldWrong, Overruns)
