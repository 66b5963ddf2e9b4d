// SPDX-License-Identifier: MIT
/// A floor that sleeps in contact for SLEEP_US, for `hapticd plugin check`.
#include <unistd.h>

#include "hapticd/shape.hpp"

namespace {

struct Sleeping : hapticd::Shape {
  double stiffness = 0;
  static constexpr hapticd::ShapeInfo kInfo{"org.example.shape.sleeping", "sleeping", "1.0.0", "MIT", "Sleeps."};
  static constexpr auto fields() {
    return std::array{
        hapticd::Fields<Sleeping>::real("stiffness", &Sleeping::stiffness, "N/m", 0, 1e4, 500, "Spring.")};
  }
  void activate(const hsp_activation&, hsp_report& report) { report.max_stiffness = stiffness; }
  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    if ((in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    out.flags = HSP_OUT_TRACED;
    out.depth_m = -in.position[1];
    out.normal[1] = 1;
    out.point[0] = in.position[0], out.point[2] = in.position[2];
    if (out.depth_m <= 0) return HSP_OK;
    usleep(SLEEP_US);
    out.flags |= HSP_OUT_CONTACT;
    out.force[1] = stiffness * out.depth_m;
    return HSP_OK;
  }
};

}  // namespace

HAPTICD_SHAPES(Sleeping)
