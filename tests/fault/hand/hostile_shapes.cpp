// SPDX-License-Identifier: MIT
/// Shapes that are out to hurt a hand, within what the ABI lets them say.
#include <cmath>

#include "hapticd/shape.hpp"

namespace {

using hapticd::Fields;

/// Is there, and is never felt.
struct Still : hapticd::Shape {
  int unused;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.still", "still", "1.0.0", "MIT", "Nothing to feel."};
  static constexpr auto fields() {
    return std::array{Fields<Still>::integer("unused", &Still::unused, "", 0, 1, 0, "Nothing.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT { return HSP_OK; }
};

/// From tick `after` on its force leaves what any motion explains.
struct Kicking : hapticd::Shape {
  int how = 0, after = 100, every = 1, ticks = 0;
  double size = 8, jump = 0;
  static constexpr const char* kHows[] = {"turns", "vibrates", "steps", "traced_turns", "hides", "spins", "stretches"};
  static constexpr hapticd::ShapeInfo kInfo{
      "org.hapticd.test.kicking", "kicking", "1.0.0", "MIT", "Kicks.", HSP_C_MOVES};
  static constexpr auto fields() {
    using F = Fields<Kicking>;
    return std::array{F::choice("how", &Kicking::how, kHows, 0,
                                "turns: round in each tick; vibrates: 50 Hz; steps: once; traced_turns: with a normal "
                                "that turns too; hides: is traced in every second tick only; spins: by its pose; "
                                "stretches: by a quaternion of length 100"),
                      F::integer("after", &Kicking::after, "", 0, 1000000, 100, "Ticks of peace."),
                      F::real("size", &Kicking::size, "N", 0, 1000, 8, "Of the force."),
                      F::real("jump", &Kicking::jump, "N", 0, 1000, 0, "That it reports to jump by; 0: nothing."),
                      F::integer("every", &Kicking::every, "", 1, 1000, 1, "Ticks from turn to turn.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    if (jump > 0) hapticd::reportJumps(report, jump);
    if (how >= 5) report.flags |= HSP_R_MOVES;
  }
  hsp_status touch(const hsp_probe&, const hsp_step& step, hsp_contact& out) noexcept HSP_RT {
    const int since = ticks++ - after;
    if (since < 0) return HSP_OK;
    const double sign = since / every % 2 == 0 ? 1 : -1;
    out.force[1] = sign * size;
    if (how == 1) out.force[1] = size * std::sin(2 * M_PI * 50 * since * 1e-3);
    if (how == 2) out.force[1] = size;
    if (how == 3 || (how == 4 && since % 2 == 0)) {
      out.flags = HSP_OUT_TRACED | HSP_OUT_CONTACT;
      out.normal[1] = sign;
      out.depth_m = 0.01;
      out.point[1] = sign * 0.01;
    }
    if (how == 5) {
      out.force[1] = size;
      step.pose->orientation[0] = since % 2 == 0 ? 1 : 0;
      step.pose->orientation[1] = since % 2 == 0 ? 0 : 1;
    }
    if (how == 6) {
      out.force[1] = 1e-3;
      step.pose->orientation[0] = 100;
    }
    return HSP_OK;
  }
};

/// Pushes with 8 N along y, and fails from tick `after` on.
struct Failing : hapticd::Shape {
  int how = 0, after = 200, ticks = 0;
  static constexpr const char* kHows[] = {"nothing", "not_finite", "status", "lost", "turns", "not_unit"};
  static constexpr hapticd::ShapeInfo kInfo{
      "org.hapticd.test.failing", "failing", "1.0.0", "MIT", "Fails.", HSP_C_MOVES};
  static constexpr auto fields() {
    using F = Fields<Failing>;
    return std::array{F::choice("how", &Failing::how, kHows, 0, "What goes wrong."),
                      F::integer("after", &Failing::after, "", 0, 1000000, 200, "Good ticks before.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    if (how == 5) report.flags |= HSP_R_MOVES;
  }
  hsp_status touch(const hsp_probe&, const hsp_step& step, hsp_contact& out) noexcept HSP_RT {
    out.force[1] = 8;
    if (ticks++ < after) return HSP_OK;
    if (how == 1) out.force[0] = std::nan("");
    if (how == 4 && ticks % 2 == 0) out.force[1] = -8;
    if (how == 5) step.pose->orientation[1] = 7;
    return how == 2 ? -77 : how == 3 ? HSP_E_NUMERIC : HSP_OK;
  }
};

/// A plate on a spring, 0.1 kg, that gives way to a press, or comes against it, since its force has the wrong sign.
struct Yielding : hapticd::Shape {
  bool comes = false;
  double height = 0, speed = 0, push = 0;  // [m], [m/s], [N] on the hand in the last step
  static constexpr double kWall = 500, kSpring = 50, kDrag = 5, kMass = 0.1;
  static constexpr hapticd::ShapeInfo kInfo{
      "org.hapticd.test.yielding", "yielding", "1.0.0", "MIT", "Gives way.", HSP_C_MOVES};
  static constexpr auto fields() {
    return std::array{Fields<Yielding>::boolean("comes", &Yielding::comes, false, "It comes against the hand.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    report.max_stiffness = kWall;
    report.size_m = 0.1;
    report.flags |= HSP_R_MOVES | HSP_R_PUSHES;
  }
  hsp_status step(const hsp_step& step) noexcept HSP_RT {
    const double before = height;
    speed += step.dt_s / kMass * ((comes ? push : -push) - kSpring * height - kDrag * speed);
    height += step.dt_s * speed;
    step.pose->position[1] += height - before;
    step.pose->linear[1] = speed;
    push = 0;
    for (uint32_t i = 0; i < step.count; ++i) {
      const hsp_probe& in = *HSP_AT(const hsp_probe, step.in, step.in_stride, i);
      hsp_contact& out = *HSP_AT(hsp_contact, step.out, step.out_stride, i);
      if ((in.flags & HSP_IN_INVALID) != 0) continue;
      out.depth_m = height - before - in.position[1];
      out.flags = HSP_OUT_TRACED | (out.depth_m > 0 ? HSP_OUT_CONTACT : 0);
      out.normal[1] = 1;
      out.point[0] = in.position[0], out.point[2] = in.position[2];
      if (out.depth_m > 0) push += out.force[1] = kWall * out.depth_m;
    }
    return HSP_OK;
  }
};

/// A floor at y = 0 with the wrong sign, which may say that it only pushes; or with the right one and no depth.
struct Pulling : hapticd::Shape {
  double stiffness = 800;
  bool claims = true, shallow = false;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.pulling", "pulling", "1.0.0", "MIT", "Pulls inward."};
  static constexpr auto fields() {
    using F = Fields<Pulling>;
    return std::array{F::real("stiffness", &Pulling::stiffness, "N/m", 0, 1e6, 800, "Stiffness."),
                      F::boolean("claims", &Pulling::claims, true, "It reports that it only pushes."),
                      F::boolean("shallow", &Pulling::shallow, false, "It pushes, and leaves depth_m at 0.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    report.max_stiffness = stiffness;
    if (claims) report.flags |= HSP_R_PUSHES;
  }
  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.flags = HSP_OUT_TRACED;
    out.depth_m = -in.position[1];
    out.point[0] = in.position[0], out.point[2] = in.position[2];
    out.normal[1] = 1;
    if (out.depth_m <= 0) return HSP_OK;
    out.flags |= HSP_OUT_CONTACT;
    out.force[1] = (shallow ? stiffness : -stiffness) * out.depth_m;
    if (shallow) out.depth_m = 0;
    return HSP_OK;
  }
};

/// Traces a surface and pushes with 1.5 N, at a depth that does not fit.
struct Shallow : hapticd::Shape {
  double depth = 0;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.shallow", "shallow", "1.0.0", "MIT", "Tells no depth."};
  static constexpr auto fields() {
    return std::array{Fields<Shallow>::real("depth", &Shallow::depth, "m", -1, 1, 0, "That it tells.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.flags = HSP_OUT_TRACED;
    out.normal[1] = 1;
    out.force[1] = 1.5;
    out.depth_m = depth;
    return HSP_OK;
  }
};

}  // namespace

HAPTICD_SHAPES(Still, Kicking, Failing, Pulling, Shallow, Yielding)
