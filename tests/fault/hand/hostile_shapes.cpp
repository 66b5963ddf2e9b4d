// SPDX-License-Identifier: MIT
/// Shapes that are out to hurt a hand, within what the ABI lets them say.
#include <cmath>

#include "hapticd/shape.hpp"

namespace {

using hapticd::Fields;

/// Is there, and is never felt.
struct Still : hapticd::Shape {
  int unused;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.still", "still", "1.0.0", "MIT", "Nothing to feel."};
  static constexpr auto fields() {
    return std::array{Fields<Still>::integer("unused", &Still::unused, "", 0, 1, 0, "Nothing.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT { return HSP_OK; }
};

}  // namespace

HAPTICD_SHAPES(Still)
