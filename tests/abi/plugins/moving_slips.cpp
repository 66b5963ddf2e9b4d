// SPDX-License-Identifier: MIT
/// Plates that move upward, with one mistake each, for `hapticd plugin check`.
#include <array>

#include "hapticd/shape.hpp"

namespace {

constexpr double kSpring = 500, kSpeed = 0.01;  // [N/m], [m/s]

/// A plate whose upper side is y = 0 of its frame. It rises with constant speed.
/// @tparam kShifts the probe is brought into the frame of the new pose
template <class Derived, bool kShifts>
struct Lift : hapticd::Shape {
  double number = 0;
  double spring = kSpring;     ///< [N/m] that is felt
  double aside = 0;            ///< [m] by which the foot point is wrong
  double told_speed = kSpeed;  ///< [m/s]
  uint32_t claims = HSP_R_MOVES | HSP_R_PUSHES;
  double tick = 0;  ///< [m] by which the plate rises in each step, however short
  static constexpr auto fields() {
    return std::array{hapticd::Fields<Derived>::real("number", &Derived::number, "", 0, 1, 0, "None.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    report.max_stiffness = kSpring;
    report.size_m = 0.1;
    report.flags |= claims;
  }
  hsp_status step(const hsp_step& step) noexcept HSP_RT {
    const double way = kSpeed * step.dt_s + tick;
    step.pose->position[1] += way;
    step.pose->linear[1] = told_speed;
    for (uint32_t i = 0; i < step.count; ++i) {
      const hsp_probe& in = *HSP_AT(const hsp_probe, step.in, step.in_stride, i);
      hsp_contact& out = *HSP_AT(hsp_contact, step.out, step.out_stride, i);
      if ((in.flags & HSP_IN_INVALID) != 0) continue;
      out.depth_m = (kShifts ? way : 0) - in.position[1];
      out.flags = HSP_OUT_TRACED | (out.depth_m > 0 ? HSP_OUT_CONTACT : 0);
      out.normal[1] = 1;
      out.point[0] = in.position[0], out.point[1] = aside, out.point[2] = in.position[2];
      if (out.depth_m > 0) out.force[1] = spring * out.depth_m;
    }
    return HSP_OK;
  }
};

struct Right : Lift<Right, true> {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.example.shape.lift_right", "lift_right", "1.0.0", "MIT", "To be tested.", HSP_C_MOVES};
};
struct Late : Lift<Late, false> {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.example.shape.lift_late", "lift_late", "1.0.0", "MIT", "To be tested.", HSP_C_MOVES};
};
struct Unsaid : Lift<Unsaid, true> {
  static constexpr hapticd::ShapeInfo kInfo{"org.example.shape.lift_unsaid", "lift_unsaid", "1.0.0", "MIT",
                                            "To be tested."};
};

struct Steep : Lift<Steep, true> {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.example.shape.lift_steep", "lift_steep", "1.0.0", "MIT", "To be tested.", HSP_C_MOVES};
  Steep() { spring = 3 * kSpring; }
};
struct Aside : Lift<Aside, true> {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.example.shape.lift_aside", "lift_aside", "1.0.0", "MIT", "To be tested.", HSP_C_MOVES};
  Aside() { aside = -0.003; }
};
struct Counting : Lift<Counting, true> {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.example.shape.lift_counting", "lift_counting", "1.0.0", "MIT", "To be tested.", HSP_C_MOVES};
  Counting() { tick = 1e-5; }
};

/// Rises, and does not report that it moves.
struct Silent : Lift<Silent, true> {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.example.shape.lift_silent", "lift_silent", "1.0.0", "MIT", "To be tested.", HSP_C_MOVES};
  Silent() { claims = HSP_R_PUSHES; }
};
/// Writes no velocity.
struct Mute : Lift<Mute, true> {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.example.shape.lift_mute", "lift_mute", "1.0.0", "MIT", "To be tested.", HSP_C_MOVES};
  Mute() { told_speed = 0; }
};
/// Has touch() beside step(), as a shape that was made of the template: step() alone is asked.
struct Both : Lift<Both, true> {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.example.shape.lift_both", "lift_both", "1.0.0", "MIT", "To be tested.", HSP_C_MOVES};
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT { return HSP_OK; }
};

/// A plate of 0.2 kg on a spring of 200 N/m, whose upper side is y = 0 of its frame.
/// @tparam kSense 1: the force of the hand presses it down; -1: it comes up against the hand
template <class Derived, int kSense>
struct Plate : hapticd::Shape {
  double number = 0, way = 0, speed = 0, push = 0;  ///< way [m], speed [m/s], push [N] of the hand
  static constexpr auto fields() {
    return std::array{hapticd::Fields<Derived>::real("number", &Derived::number, "", 0, 1, 0, "None.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    report.max_stiffness = kSpring;
    report.size_m = 0.1;
    report.flags |= HSP_R_MOVES | HSP_R_PUSHES;
  }
  void reset() noexcept HSP_RT { way = speed = push = 0; }
  hsp_status step(const hsp_step& step) noexcept HSP_RT {
    const double before = way;
    speed += (-kSense * push - 200 * way - 4 * speed) / 0.2 * step.dt_s;
    way += speed * step.dt_s;
    step.pose->position[1] = way, step.pose->linear[1] = speed;
    push = 0;
    for (uint32_t i = 0; i < step.count; ++i) {
      const hsp_probe& in = *HSP_AT(const hsp_probe, step.in, step.in_stride, i);
      hsp_contact& out = *HSP_AT(hsp_contact, step.out, step.out_stride, i);
      if ((in.flags & HSP_IN_INVALID) != 0) continue;
      out.depth_m = way - before - in.position[1];
      out.flags = HSP_OUT_TRACED | (out.depth_m > 0 ? HSP_OUT_CONTACT : 0);
      out.normal[1] = 1;
      out.point[0] = in.position[0], out.point[2] = in.position[2];
      if (out.depth_m > 0) push += out.force[1] = kSpring * out.depth_m;
    }
    return HSP_OK;
  }
};
struct GivesWay : Plate<GivesWay, 1> {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.example.shape.gives_way", "gives_way", "1.0.0", "MIT", "To be tested.", HSP_C_MOVES};
};
struct ComesUp : Plate<ComesUp, -1> {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.example.shape.comes_up", "comes_up", "1.0.0", "MIT", "To be tested.", HSP_C_MOVES};
};

}  // namespace

HAPTICD_SHAPES(Right, Late, Unsaid, Steep, Aside, Counting, Silent, Mute, Both, GivesWay, ComesUp)
