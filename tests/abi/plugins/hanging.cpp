// SPDX-License-Identifier: MIT
/// A shape whose step never comes back: the check of a plugin must end soon all the same.
#include <unistd.h>

#include "hapticd/shape.hpp"

namespace {

struct Hanging : hapticd::Shape {
  double stiffness = 0;
  static constexpr hapticd::ShapeInfo kInfo{"org.example.shape.hanging", "hanging", "1.0.0", "MIT", "Hangs."};
  static constexpr auto fields() {
    return std::array{hapticd::Fields<Hanging>::real("stiffness", &Hanging::stiffness, "N/m", 0, 1e4, 500, "Spring.")};
  }
  void activate(const hsp_activation&, hsp_report& report) { report.max_stiffness = stiffness; }
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT {
    for (;;) pause();
  }
};

}  // namespace

HAPTICD_SHAPES(Hanging)
