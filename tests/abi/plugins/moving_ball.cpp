// SPDX-License-Identifier: MIT
/// A ball that moves to and fro along its x axis: a whole shape that moves by itself, for
/// driver/docs/writing_a_shape.md.
#include <array>
#include <cmath>

#include "hapticd/shape.hpp"

namespace {

struct MovingBall : hapticd::Shape {
  double radius = 0, stiffness = 0, amplitude = 0, rate = 0;

  static constexpr hapticd::ShapeInfo kInfo{"org.example.shape.moving_ball",
                                            "moving_ball",
                                            "1.0",
                                            "MIT",
                                            "A ball that moves to and fro along its x axis.",
                                            HSP_C_MOVES};
  static constexpr auto fields() {
    using F = hapticd::Fields<MovingBall>;
    return std::array{
        F::real("radius", &MovingBall::radius, "m", 0.001, 1, 0.03, "Radius of the ball."),
        F::real("stiffness", &MovingBall::stiffness, "N/m", 0, 5000, 500, "Force for each metre of depth."),
        F::real("amplitude", &MovingBall::amplitude, "m", 0, 0.2, 0.02, "Way to either side."),
        F::real("rate", &MovingBall::rate, "Hz", 0, 2, 0.5, "Ways to and fro per second.")};
  }

  void activate(const hsp_activation& activation, hsp_report& report) {
    home_ = activation.pose;
    time_ = way_ = 0;
    report.max_stiffness = stiffness;
    report.size_m = 2 * radius;
    report.flags |= HSP_R_MOVES | HSP_R_PUSHES;
  }

  /// Moves, writes the pose, and answers in the frame of this pose.
  hsp_status step(const hsp_step& step) noexcept HSP_RT {
    time_ += step.dt_s;
    const double turn = 2 * M_PI * rate * time_, before = way_;
    way_ = amplitude * std::sin(turn);
    place(*step.pose, 2 * M_PI * rate * amplitude * std::cos(turn));
    return hapticd::touchEach(step, [&](const hsp_probe& probe, hsp_contact& contact, uint32_t) {
      touch(probe, way_ - before, contact);
      return HSP_OK;
    });
  }

 private:
  /// Writes position and velocity [m/s], both in the world frame. The ball does not turn.
  void place(hsp_pose& pose, double speed) const noexcept HSP_RT {
    const double* q = home_.orientation;  // w, x, y, z
    const double axis[3] = {1 - 2 * (q[2] * q[2] + q[3] * q[3]), 2 * (q[1] * q[2] + q[0] * q[3]),
                            2 * (q[1] * q[3] - q[0] * q[2])};  // the ball's x axis in the world
    pose = home_;
    for (int i = 0; i < 3; ++i) pose.position[i] += way_ * axis[i], pose.linear[i] = speed * axis[i];
  }

  /// Answers one probe. @param moved [m] way along x in this step: the probe comes in the frame before it
  void touch(const hsp_probe& probe, double moved, hsp_contact& out) const noexcept HSP_RT {
    if ((probe.flags & HSP_IN_INVALID) != 0) return;
    const double p[3] = {probe.position[0] - moved, probe.position[1], probe.position[2]};
    const double distance = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    if (distance == 0) return;
    out.flags = HSP_OUT_TRACED;
    out.depth_m = radius - distance;
    if (out.depth_m > 0) out.flags |= HSP_OUT_CONTACT;
    for (int i = 0; i < 3; ++i) {
      out.normal[i] = p[i] / distance;
      out.point[i] = radius * out.normal[i];
      if (out.depth_m > 0) out.force[i] = stiffness * out.depth_m * out.normal[i];
    }
  }

  hsp_pose home_{};            // pose at the start
  double time_ = 0, way_ = 0;  // s, m
};

}  // namespace

HAPTICD_SHAPES(MovingBall)
