// SPDX-License-Identifier: MIT
/// A ball: the smallest whole plugin. `hapticd plugin new NAME` copies it under another name.
#include <cmath>

#include "hapticd/shape.hpp"

namespace {

struct TemplateBall : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.shape.template", "template", "0.1.0", "MIT",
                                            "A ball about the model's origin; the plugin to start from."};
  double radius = 0, stiffness = 0;

  static constexpr auto fields() {
    using F = hapticd::Fields<TemplateBall>;
    return std::array{
        F::real("radius", &TemplateBall::radius, "m", 0.001, 1, 0.05, "Radius of the ball."),
        F::real("stiffness", &TemplateBall::stiffness, "N/m", 0, 5000, 500, "Force for each metre of depth.",
                HSP_P_LIVE),
    };
  }

  /// May allocate, and throw std::exception with a message for the user. Claims what the host may rely on.
  void activate(const hsp_activation&, hsp_report& report) {
    report.max_stiffness = stiffness;
    report.flags = HSP_R_PUSHES;  // without friction: a force that pulls inward is then found to be a mistake
    report.size_m = 2 * radius;
    report.typical_ns = 50;
    report.worst_ns = 2000;
  }

  /// Every tick, for each probe: no allocation, lock, system call or exception. Model frame, SI units.
  hsp_status touch(const hsp_probe& probe, const hsp_step&, hsp_contact& contact) noexcept HSP_RT {
    if ((probe.flags & HSP_IN_INVALID) != 0) return HSP_OK;  // no sample: no force
    const double* p = probe.position;
    const double distance = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    if (distance == 0) return HSP_E_NUMERIC;  // the very centre has no nearest side
    contact.depth_m = radius - distance;
    const double push = contact.depth_m > 0 ? stiffness * contact.depth_m : 0;
    for (int i = 0; i < 3; ++i) {
      contact.normal[i] = p[i] / distance;
      contact.point[i] = radius * contact.normal[i];
      contact.force[i] = push * contact.normal[i];
    }
    contact.stiffness = contact.depth_m > 0 ? stiffness : 0;
    contact.flags = HSP_OUT_TRACED;
    if (contact.depth_m > 0) contact.flags |= HSP_OUT_CONTACT;
    return HSP_OK;
  }
};

}  // namespace

HAPTICD_SHAPES(TemplateBall)
