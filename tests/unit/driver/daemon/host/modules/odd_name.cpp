// SPDX-License-Identifier: MIT
/// Has a name of two lines.
#include "hapticd/shape.hpp"

namespace {
struct Odd : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.odd_name", "odd_name\n", "1", "MIT", "Bad."};
  static constexpr auto fields() { return std::array<hapticd::Field<Odd>, 0>{}; }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT { return HSP_OK; }
};
}  // namespace

HAPTICD_SHAPES(Odd)
