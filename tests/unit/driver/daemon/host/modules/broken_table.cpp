// SPDX-License-Identifier: MIT
/// Describes one parameter twice.
#include "hapticd/shape.hpp"

namespace {
struct Broken : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.broken", "broken_table", "1", "MIT", "Broken."};
  double a = 0;
  static constexpr auto fields() {
    using F = hapticd::Fields<Broken>;
    return std::array{F::real("a", &Broken::a, "", 0, 1, 0, "One."), F::real("a", &Broken::a, "", 0, 1, 0, "Two.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT { return HSP_OK; }
};
}  // namespace

HAPTICD_SHAPES(Broken)
