// SPDX-License-Identifier: MIT
/// Has no id, so that no recording could name it.
#include "hapticd/shape.hpp"

namespace {
struct Nameless : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{nullptr, "no_id", "1", "MIT", "Bad."};
  static constexpr auto fields() { return std::array<hapticd::Field<Nameless>, 0>{}; }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT { return HSP_OK; }
};
}  // namespace

HAPTICD_SHAPES(Nameless)
