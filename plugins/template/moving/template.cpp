// SPDX-License-Identifier: MIT
/// A plate on a spring: a small complete shape that moves by itself, under the forces of the hand.
/// `hapticd plugin new NAME --moving` copies it under another name; delete what your shape does not need.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "hapticd/shape.hpp"

namespace {

/// The plate lies in the plane of x and z of its frame, and moves along y. Its edges are round: its surface is where
/// the distance to a rectangle is half the thickness. So it has one nearest point and one normal for every probe near
/// it.
struct TemplatePlate : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.shape.template",
                                            "template",
                                            "0.1.0",
                                            "MIT",
                                            "A plate on a spring; start your own moving shape from it.",
                                            HSP_C_MOVES};

  double width = 0, thickness = 0, stiffness = 0, mass = 0, spring = 0, damping = 0;

  static constexpr auto fields() {
    using F = hapticd::Fields<TemplatePlate>;
    return std::array{
        F::real("width", &TemplatePlate::width, "m", 0.001, 1, 0.1, "Width of the plate along x and z."),
        F::real("thickness", &TemplatePlate::thickness, "m", 0.002, 0.2, 0.02, "Thickness of the plate."),
        F::real("stiffness", &TemplatePlate::stiffness, "N/m", 1, 5000, 1000, "Stiffness of the surface."),
        F::real("mass", &TemplatePlate::mass, "kg", 0.001, 100, 0.2, "Mass of the plate."),
        F::real("spring", &TemplatePlate::spring, "N/m", 0, 5000, 150, "Stiffness of the spring below the plate."),
        F::real("damping", &TemplatePlate::damping, "N s/m", 0, 100, 4, "Damping of the spring."),
    };
  }

  void activate(const hsp_activation& activation, hsp_report& report) {
    home_ = activation.pose;
    travel_ = rate_ = push_ = give_ = 0;
    report.max_stiffness = stiffness;
    report.size_m = std::hypot(width, width, thickness) + thickness;
    report.flags |= HSP_R_MOVES | HSP_R_PUSHES;
  }

  /// Forgets the contacts, because the next probe may be elsewhere. Travel and speed stay: a body does not jump.
  void reset() noexcept HSP_RT { push_ = give_ = 0; }

  /// Moves, writes the new pose, and answers in the frame of the new pose. The probes come in the frame of the old one.
  hsp_status step(const hsp_step& step) noexcept HSP_RT {
    const double before = travel_;
    move(step.dt_s);
    place(*step.pose);
    push_ = give_ = 0;
    return hapticd::touchEach(step, [&](const hsp_probe& probe, hsp_contact& contact, uint32_t) {
      touch(probe, travel_ - before, contact);
      return HSP_OK;
    });
  }

  /// Returns triangles for `run --view` and other drawings. Forces do not need them.
  const void* extension(const char* name) {
    static constexpr hsp_ext_geometry kGeometry = {sizeof(hsp_ext_geometry), 0, &tessellate, &bounds};
    return std::strcmp(name, HSP_EXT_GEOMETRY) == 0 ? &kGeometry : nullptr;
  }

 private:
  /// Advances by dt [s] under the contacts of the last step, by backward Euler: forces are those at the end of the
  /// step, which the plate reaches with its new rate. So the motion is stable for every mass and stiffness. With forces
  /// of the beginning of the step a light plate would tremble at the hand.
  void move(double dt) noexcept HSP_RT {
    rate_ = (mass * rate_ - dt * (spring * travel_ + push_)) / (mass + dt * damping + dt * dt * (spring + give_));
    travel_ += dt * rate_;
  }

  /// Writes position and velocity, both in the world frame. The plate does not turn.
  void place(hsp_pose& pose) const noexcept HSP_RT {
    const double* q = home_.orientation;  // w, x, y, z
    const double axis[3] = {2 * (q[1] * q[2] - q[0] * q[3]), 1 - 2 * (q[1] * q[1] + q[3] * q[3]),
                            2 * (q[2] * q[3] + q[0] * q[1])};  // the plate's y axis in the world
    pose = home_;
    for (int i = 0; i < 3; ++i) pose.position[i] += travel_ * axis[i], pose.linear[i] = rate_ * axis[i];
  }

  /// Answers one probe, and keeps how it pushes the plate. @param moved [m] by which the plate moved in this step
  void touch(const hsp_probe& probe, double moved, hsp_contact& out) noexcept HSP_RT {
    if ((probe.flags & HSP_IN_INVALID) != 0) return;  // no sample: no force
    const double half = width / 2;
    const double p[3] = {probe.position[0], probe.position[1] - moved, probe.position[2]};
    const double core[3] = {std::clamp(p[0], -half, half), 0, std::clamp(p[2], -half, half)};  // in the rectangle
    const double distance = std::hypot(p[0] - core[0], p[1], p[2] - core[2]);
    if (distance == 0) return;  // no side of the plate is nearer than the other
    out.flags = HSP_OUT_TRACED;
    out.depth_m = thickness / 2 - distance;
    for (int i = 0; i < 3; ++i) {
      out.normal[i] = (p[i] - core[i]) / distance;
      out.point[i] = core[i] + thickness / 2 * out.normal[i];
    }
    if (!(out.depth_m > 0)) return;
    out.flags |= HSP_OUT_CONTACT;
    out.stiffness = stiffness;
    for (int i = 0; i < 3; ++i) out.force[i] = stiffness * out.depth_m * out.normal[i];
    push_ += out.force[1];                               // what pushes the probe up pushes the plate down
    give_ += stiffness * out.normal[1] * out.normal[1];  // and it grows as the plate comes up against the probe
  }

  static TemplatePlate& self(hsp_shape* shape) { return *reinterpret_cast<TemplatePlate*>(shape); }

  static hsp_status bounds(hsp_shape* shape, double min[3], double max[3]) {
    const TemplatePlate& plate = self(shape);
    for (int i = 0; i < 3; ++i) max[i] = (plate.thickness + (i == 1 ? 0 : plate.width)) / 2, min[i] = -max[i];
    return HSP_OK;
  }

  /// Makes a sphere of half the thickness whose quarters stand at the corners of the rectangle, and closes it above and
  /// below. The arrays stay valid until the next call.
  static hsp_status tessellate(hsp_shape* shape, double /*chord_error_m*/, hsp_mesh* mesh) {
    constexpr uint32_t kRings = 12, kSteps = 6, kSides = 4 * (kSteps + 1);
    TemplatePlate& plate = self(shape);
    plate.xyz_.clear(), plate.normals_.clear(), plate.indices_.clear();
    for (uint32_t i = 0; i <= kRings; ++i)
      for (uint32_t k = 0; k < kSides; ++k) {
        const uint32_t quarter = k / (kSteps + 1), step = k % (kSteps + 1);
        const double down = M_PI * i / kRings, round = M_PI / 2 * (quarter + static_cast<double>(step) / kSteps);
        const double n[3] = {std::sin(down) * std::cos(round), std::cos(down), -std::sin(down) * std::sin(round)};
        const double corner[3] = {quarter == 0 || quarter == 3 ? 1.0 : -1.0, 0, quarter < 2 ? -1.0 : 1.0};
        for (int axis = 0; axis < 3; ++axis) {
          plate.normals_.push_back(static_cast<float>(n[axis]));
          plate.xyz_.push_back(static_cast<float>((plate.width * corner[axis] + plate.thickness * n[axis]) / 2));
        }
        const uint32_t a = i * kSides + k, right = i * kSides + (k + 1) % kSides, b = a + kSides, c = right + kSides;
        if (i < kRings) plate.indices_.insert(plate.indices_.end(), {a, b, right, right, b, c});
      }
    constexpr uint32_t kQuarter = kSteps + 1, kLast = kRings * kSides;  // the flat faces
    plate.indices_.insert(plate.indices_.end(), {0, kQuarter, 2 * kQuarter, 0, 2 * kQuarter, 3 * kQuarter});
    plate.indices_.insert(plate.indices_.end(), {kLast, kLast + 2 * kQuarter, kLast + kQuarter, kLast,
                                                 kLast + 3 * kQuarter, kLast + 2 * kQuarter});
    mesh->xyz = plate.xyz_.data(), mesh->normals = plate.normals_.data(), mesh->indices = plate.indices_.data();
    mesh->vertex_count = static_cast<uint32_t>(plate.xyz_.size() / 3);
    mesh->triangle_count = static_cast<uint32_t>(plate.indices_.size() / 3);
    return HSP_OK;
  }

  hsp_pose home_{};                   // pose at rest
  double travel_ = 0, rate_ = 0;      // [m], [m/s] along y
  double push_ = 0, give_ = 0;        // [N] force of all probes along y in the last step; [N/m] how fast it grows
  std::vector<float> xyz_, normals_;  // for drawing
  std::vector<uint32_t> indices_;
};

}  // namespace

HAPTICD_SHAPES(TemplatePlate)
