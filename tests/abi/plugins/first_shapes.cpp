// SPDX-License-Identifier: MIT
/// Balls and plates with one mistake each, as a researcher makes it in a first shape, for `hapticd plugin check`.
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <vector>

#include "hapticd/shape.hpp"

namespace {

enum class Slip {
  kNone,
  kPushesAndRubs,  ///< friction, and HSP_R_PUSHES
  kDampsOdd,       ///< a damper whose unit is "Ns/m"
  kEmptyReset,     ///< friction whose stuck point outlives reset()
  kLongNormal,     ///< the normal is not of length 1
  kAtOnce,         ///< 0.5 N from the first touch on
  kNoCentre,       ///< divides by the distance from the centre
  kClock,          ///< the force swings with the processor time
  kGivesMore,      ///< pushes more on the way out than on the way in
  kNoDoc,          ///< a parameter without a text
  kTurns,          ///< reads the orientation and does not ask for it
  kDiameter        ///< the foot point is at the diameter instead of the radius
};

constexpr double kRadius = 0.04, kSpring = 500;

/// What is kept of each probe.
struct Kept {
  bool holds = false;
  double at[3] = {0, 0, 0}, depth = 0;
};

size_t numberOf(const hsp_probe& in, const hsp_step& step) {
  const auto bytes = reinterpret_cast<const char*>(&in) - reinterpret_cast<const char*>(step.in);
  return static_cast<size_t>(bytes) / step.in_stride;
}

template <class Derived, Slip kSlip>
struct Ball : hapticd::Shape {
  double number = 0;
  std::vector<Kept> kept;
  static constexpr bool is(Slip slip) { return kSlip == slip; }
  static constexpr bool kRubs = kSlip == Slip::kPushesAndRubs || kSlip == Slip::kEmptyReset;
  static constexpr auto fields() {
    return std::array{hapticd::Fields<Derived>::real("number", &Derived::number, is(Slip::kDampsOdd) ? "Ns/m" : "N/m",
                                                     0, 1, 0, is(Slip::kNoDoc) ? "" : "None.")};
  }
  void activate(const hsp_activation& activation, hsp_report& report) {
    kept.assign(activation.max_probes, {});
    report.max_stiffness = kSpring;
    report.size_m = 2 * kRadius;
    if (is(Slip::kPushesAndRubs)) report.flags |= HSP_R_PUSHES;
  }
  void reset() noexcept HSP_RT {
    if (!is(Slip::kEmptyReset)) std::fill(kept.begin(), kept.end(), Kept{});
  }

  /// Holds the tip at the point where it has touched, with at most a third of the push.
  static void rub(Kept& mine, const double* p, double push, hsp_contact& out) {
    if (!mine.holds) std::copy_n(p, 3, mine.at);
    mine.holds = true;
    double along[3], dot = 0, length = 0;
    for (int i = 0; i < 3; ++i) dot += (p[i] - mine.at[i]) * out.normal[i];
    for (int i = 0; i < 3; ++i) along[i] = p[i] - mine.at[i] - dot * out.normal[i], length += along[i] * along[i];
    const double pull = kSpring * std::sqrt(length), part = pull > push / 3 ? push / 3 / pull : 1;
    for (int i = 0; i < 3; ++i) out.force[i] -= kSpring * part * along[i];
    for (int i = 0; i < 3 && part < 1; ++i) mine.at[i] = p[i] - part * along[i];
  }

  double pushOf(const hsp_probe& in, Kept& mine, double depth) const {
    double push = kSpring * depth;
    if (is(Slip::kAtOnce)) push += 0.5;
    if (is(Slip::kClock)) push *= 1 + 0.01 * std::sin(1e-3 * static_cast<double>(std::clock()));
    if (is(Slip::kGivesMore) && depth < mine.depth) push *= 1.2;
    if (is(Slip::kTurns)) push *= 1 + in.orientation[1] * in.orientation[1];
    mine.depth = depth;
    return push;
  }

  hsp_status touch(const hsp_probe& in, const hsp_step& step, hsp_contact& out) noexcept HSP_RT {
    Kept& mine = kept[numberOf(in, step)];
    if ((in.flags & (HSP_IN_JUMP | HSP_IN_INVALID)) != 0) mine = {};
    if ((in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    const double* p = in.position;
    const double far = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    if (far == 0 && !is(Slip::kNoCentre)) return HSP_E_NUMERIC;
    out.flags = HSP_OUT_TRACED;
    out.depth_m = kRadius - far;
    for (int i = 0; i < 3; ++i) {
      out.normal[i] = p[i] / far;
      out.point[i] = (is(Slip::kDiameter) ? 2 : 1) * kRadius * out.normal[i];
    }
    if (out.depth_m <= 0) mine = {};
    if (out.depth_m > 0) {
      out.flags |= HSP_OUT_CONTACT;
      const double push = pushOf(in, mine, out.depth_m);
      for (int i = 0; i < 3; ++i) out.force[i] = push * out.normal[i];
      if (kRubs) rub(mine, p, push, out);
    }
    for (int i = 0; i < 3 && is(Slip::kLongNormal); ++i) out.normal[i] *= far / kRadius;
    return HSP_OK;
  }
};

/// A plate about the plane y = kAt whose nearest side is felt. @tparam kThickUm its thickness [um] @tparam kTwists
/// gives a torque about the model's origin, a mistake @tparam kAt its height [m]
template <class Derived, int kThickUm, bool kTwists = false, int kAt = 0>
struct Plate : hapticd::Shape {
  static constexpr double kThick = 1e-6 * kThickUm;
  double number = 0;
  static constexpr auto fields() {
    return std::array{hapticd::Fields<Derived>::real("number", &Derived::number, "", 0, 1, 0, "None.")};
  }
  void activate(const hsp_activation&, hsp_report& report) { report.max_stiffness = kSpring; }
  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    if ((in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    const double y = in.position[1] - kAt, side = y < 0 ? -1 : 1;
    out.flags = HSP_OUT_TRACED;
    out.depth_m = kThick / 2 - std::abs(y);
    out.normal[1] = side;
    out.point[0] = in.position[0], out.point[1] = kAt + side * kThick / 2, out.point[2] = in.position[2];
    if (out.depth_m <= 0) return HSP_OK;
    out.flags |= HSP_OUT_CONTACT;
    out.force[1] = side * kSpring * out.depth_m;
    if (kTwists) out.torque[0] = -in.position[2] * out.force[1], out.torque[2] = in.position[0] * out.force[1];
    return HSP_OK;
  }
};

#define SHAPE(NAME, TYPE, ...)                                                                                   \
  struct TYPE : __VA_ARGS__ {                                                                                    \
    static constexpr hapticd::ShapeInfo kInfo{"org.example.shape." NAME, NAME, "1.0.0", "MIT", "To be tested."}; \
  };

SHAPE("first_right", Right, Ball<Right, Slip::kNone>)
SHAPE("pushes_and_rubs", PushesAndRubs, Ball<PushesAndRubs, Slip::kPushesAndRubs>)
SHAPE("damps_odd", DampsOdd, Ball<DampsOdd, Slip::kDampsOdd>)
SHAPE("empty_reset", EmptyReset, Ball<EmptyReset, Slip::kEmptyReset>)
SHAPE("long_normal", LongNormal, Ball<LongNormal, Slip::kLongNormal>)
SHAPE("origin_torque", OriginTorque, Plate<OriginTorque, 50000, true>)
SHAPE("at_once", AtOnce, Ball<AtOnce, Slip::kAtOnce>)
SHAPE("no_centre", NoCentre, Ball<NoCentre, Slip::kNoCentre>)
SHAPE("clock", Clock, Ball<Clock, Slip::kClock>)
SHAPE("gives_more", GivesMore, Ball<GivesMore, Slip::kGivesMore>)
SHAPE("no_doc", NoDoc, Ball<NoDoc, Slip::kNoDoc>)
SHAPE("turns", Turns, Ball<Turns, Slip::kTurns>)
SHAPE("diameter", Diameter, Ball<Diameter, Slip::kDiameter>)
SHAPE("thin_plate", ThinPlate, Plate<ThinPlate, 500>)
SHAPE("slab", Slab, Plate<Slab, 4000>)
SHAPE("far_plate", FarPlate, Plate<FarPlate, 50000, false, -5>)

/// Walks the records of a step as an array, as a first shape in C does.
struct PlainIndex : Ball<PlainIndex, Slip::kNone> {
  static constexpr hapticd::ShapeInfo kInfo{"org.example.shape.plain_index", "plain_index", "1.0.0", "MIT",
                                            "To be tested."};
  hsp_status step(const hsp_step& step) noexcept HSP_RT {
    for (uint32_t i = 0; i < step.count; ++i) touch(step.in[i], step, step.out[i]);
    return HSP_OK;
  }
};

}  // namespace

HAPTICD_SHAPES(Right, PushesAndRubs, DampsOdd, EmptyReset, LongNormal, OriginTorque, AtOnce, NoCentre, Clock, GivesMore,
               NoDoc, Turns, Diameter, ThinPlate, Slab, FarPlate, PlainIndex)
