// SPDX-License-Identifier: MIT
/// Has a default that its own range does not allow.
#include "hapticd/shape.hpp"

namespace {
struct Beyond : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.wrong_default", "wrong_default", "1", "MIT", "Beyond."};
  double a = 0;
  static constexpr auto fields() {
    using F = hapticd::Fields<Beyond>;
    return std::array{F::real("a", &Beyond::a, "", 0.01, 1, 2.5, "Its greatest value is 1.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT { return HSP_OK; }
};
}  // namespace

HAPTICD_SHAPES(Beyond)
