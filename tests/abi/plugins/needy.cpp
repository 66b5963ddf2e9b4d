// SPDX-License-Identifier: MIT
/// A floor that requires parameters of every kind, for `hapticd plugin check --set`; and one whose depth has the wrong
/// sign.
#include <fstream>
#include <stdexcept>

#include "hapticd/shape.hpp"

namespace {

using hapticd::Fields;

struct Needy : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{"org.example.shape.needy", "needy", "1.0.0", "MIT", "Needs a file."};
  static constexpr const char* kLaws[] = {"linear", "square"};
  double stiffness = 0;
  int law = 0, rows = 0;
  bool felt = true;
  std::string heights, geometry;
  std::array<double, 3> axis{};
  static constexpr auto fields() {
    using F = Fields<Needy>;
    return std::array{
        F::real("stiffness", &Needy::stiffness, "N/m", 0, 5000, 500, "Spring."),
        F::choice("law", &Needy::law, kLaws, 0, "Law."),
        F::integer("rows", &Needy::rows, "", 1, 10, 2, "Rows."),
        F::boolean("felt", &Needy::felt, true, "Whether it pushes."),
        F::path("heights", &Needy::heights, "File of heights.", HSP_P_REQUIRED),
        F::path("geometry", &Needy::geometry, "Not a model of ours.", HSP_P_REQUIRED),
        F::vector3("axis", &Needy::axis, "", -1, 1, "[0, 0, 0]", "Must not be zero."),
    };
  }
  void activate(const hsp_activation&, hsp_report& report) {
    std::string word;
    if (std::ifstream in(heights); !(in >> word) || word != "heights")
      throw std::runtime_error("not a file of heights");
    if (axis[0] == 0 && axis[1] == 0 && axis[2] == 0) throw std::runtime_error("axis is zero");
    report.max_stiffness = stiffness;
  }
  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    if ((in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    out.flags = HSP_OUT_TRACED;
    out.normal[1] = 1;
    out.point[0] = in.position[0], out.point[2] = in.position[2];
    out.depth_m = -in.position[1];
    if (out.depth_m <= 0) return HSP_OK;
    out.flags |= HSP_OUT_CONTACT;
    out.force[1] = felt ? stiffness * out.depth_m : 0;
    return HSP_OK;
  }
};

/// Depth grows with height, and so does the force: it throws the hand away.
struct UpsideDown : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{"org.example.shape.upside_down", "upside_down", "1.0.0", "MIT", "Wrong."};
  double stiffness = 0;
  static constexpr auto fields() {
    return std::array{Fields<UpsideDown>::real("stiffness", &UpsideDown::stiffness, "N/m", 0, 5000, 500, "Spring.")};
  }
  void activate(const hsp_activation&, hsp_report& report) { report.max_stiffness = stiffness; }
  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    if ((in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    out.flags = HSP_OUT_TRACED;
    out.normal[1] = 1;
    out.point[0] = in.position[0], out.point[2] = in.position[2];
    out.depth_m = in.position[1];
    if (out.depth_m <= 0) return HSP_OK;
    out.flags |= HSP_OUT_CONTACT;
    out.force[1] = stiffness * out.depth_m;
    return HSP_OK;
  }
};

}  // namespace

HAPTICD_SHAPES(Needy, UpsideDown)
