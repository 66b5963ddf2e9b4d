// SPDX-License-Identifier: MIT
/// Rings that are felt as they should be, and drawn with one slip each, for `hapticd plugin check`.
#include <cmath>
#include <cstring>
#include <vector>

#include "hapticd/shape.hpp"

namespace {

enum class Slip {
  kNone,
  kInContact,    ///< it names its surface in contact alone: no slip
  kSmallBounds,  ///< the tube is left out
  kMillimetres,  ///< corners and bounds
  kTurned,       ///< about z instead of y
  kInsideOut,
  kWrongIndex,  ///< counted from 1
  kOnlyBounds   ///< it draws nothing, and its bounds leave out the tube
};

constexpr double kRadius = 0.04, kTube = 0.01;
constexpr uint32_t kSides = 48;

template <class Derived, Slip kSlip>
struct Ring : hapticd::Shape {
  double stiffness = 0;
  std::vector<float> xyz;
  std::vector<uint32_t> indices;

  static constexpr auto fields() {
    return std::array{hapticd::Fields<Derived>::real("stiffness", &Derived::stiffness, "N/m", 0, 5000, 500, "Spring.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    report.max_stiffness = stiffness;
    report.flags = HSP_R_PUSHES;
    report.size_m = 2 * (kRadius + kTube);
  }
  const void* extension(const char* name) {
    static constexpr hsp_ext_geometry kGeometry = {sizeof(hsp_ext_geometry), 0, &tessellate, &bounds};
    return std::strcmp(name, HSP_EXT_GEOMETRY) == 0 ? &kGeometry : nullptr;
  }

  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    if ((in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    const double* p = in.position;
    const double around = std::hypot(p[0], p[2]) + 1e-300, part = 1 - kRadius / around;
    const double from[3] = {p[0] * part, p[1], p[2] * part};  // the circle in the tube's middle
    const double distance = std::sqrt(from[0] * from[0] + from[1] * from[1] + from[2] * from[2]) + 1e-300;
    const double depth = kTube - distance;
    if (kSlip == Slip::kInContact && !(depth > 0)) return HSP_OK;
    out.flags = HSP_OUT_TRACED;
    if (depth > 0) out.flags |= HSP_OUT_CONTACT;
    out.depth_m = depth;
    for (int i = 0; i < 3; ++i) {
      out.normal[i] = from[i] / distance;
      out.point[i] = p[i] + depth * out.normal[i];
      out.force[i] = depth > 0 ? stiffness * depth * out.normal[i] : 0;
    }
    return HSP_OK;
  }

  static Derived& self(hsp_shape* shape) { return *reinterpret_cast<Derived*>(shape); }
  static constexpr double unit() { return kSlip == Slip::kMillimetres ? 1000 : 1; }

  static hsp_status bounds(hsp_shape*, double min[3], double max[3]) {
    const double tube = kSlip == Slip::kSmallBounds || kSlip == Slip::kOnlyBounds ? 0 : kTube;
    for (int i = 0; i < 3; ++i) max[i] = unit() * (kRadius + tube);
    if (kSlip != Slip::kTurned) max[1] = unit() * kTube;
    if (kSlip == Slip::kTurned) max[2] = unit() * kTube;
    for (int i = 0; i < 3; ++i) min[i] = -max[i];
    return HSP_OK;
  }

  static hsp_status tessellate(hsp_shape* shape, double, hsp_mesh* mesh) {
    if (kSlip == Slip::kOnlyBounds) return HSP_E_STATE;
    Derived& ring = self(shape);
    ring.xyz.clear(), ring.indices.clear();
    for (uint32_t i = 0; i <= kSides; ++i)
      for (uint32_t k = 0; k <= kSides; ++k) {
        const double round = 2 * M_PI * i / kSides, over = 2 * M_PI * k / kSides;
        const double far = kRadius + kTube * std::cos(over), up = kTube * std::sin(over);
        double p[3] = {far * std::cos(round), up, -far * std::sin(round)};
        if (kSlip == Slip::kTurned) p[1] = -p[2], p[2] = up;
        for (const double v : p) ring.xyz.push_back(static_cast<float>(unit() * v));
        const uint32_t a = i * (kSides + 1) + k, b = a + kSides + 1, more = kSlip == Slip::kWrongIndex ? 1 : 0;
        if (i == kSides || k == kSides) continue;
        for (const uint32_t corner : {a, b, a + 1, a + 1, b, b + 1}) ring.indices.push_back(corner + more);
        if (kSlip != Slip::kInsideOut) continue;
        std::swap(ring.indices.back(), ring.indices.end()[-2]);
        std::swap(ring.indices.end()[-4], ring.indices.end()[-5]);
      }
    mesh->xyz = ring.xyz.data(), mesh->indices = ring.indices.data();
    mesh->vertex_count = static_cast<uint32_t>(ring.xyz.size() / 3);
    mesh->triangle_count = static_cast<uint32_t>(ring.indices.size() / 3);
    return HSP_OK;
  }
};

#define SHAPE(NAME, TYPE, SLIP)                                                                                  \
  struct TYPE : Ring<TYPE, Slip::SLIP> {                                                                         \
    static constexpr hapticd::ShapeInfo kInfo{"org.example.shape." NAME, NAME, "1.0.0", "MIT", "To be tested."}; \
  };

SHAPE("drawn_right", DrawnRight, kNone)
SHAPE("drawn_in_contact", DrawnInContact, kInContact)
SHAPE("drawn_small_bounds", DrawnSmallBounds, kSmallBounds)
SHAPE("drawn_millimetres", DrawnMillimetres, kMillimetres)
SHAPE("drawn_turned", DrawnTurned, kTurned)
SHAPE("drawn_inside_out", DrawnInsideOut, kInsideOut)
SHAPE("drawn_wrong_index", DrawnWrongIndex, kWrongIndex)
SHAPE("only_bounds", OnlyBounds, kOnlyBounds)

}  // namespace

HAPTICD_SHAPES(DrawnRight, DrawnInContact, DrawnSmallBounds, DrawnMillimetres, DrawnTurned, DrawnInsideOut,
               DrawnWrongIndex, OnlyBounds)
