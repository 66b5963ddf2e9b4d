// SPDX-License-Identifier: MIT
/// Rings that are softer at some places of their circle, as a cold reader built them and `hapticd plugin check` passed
/// them: the force of some is not the slope of an energy. Others are honest.
#include <array>
#include <cmath>
#include <vector>

#include "hapticd/shape.hpp"

namespace {

constexpr double kRadius = 0.04, kTube = 0.012, kWidth = 0.4;  // [m]; [rad] half of the angle over which a dent fades

enum class Soft {
  kNormal,  ///< k(phi) d along the normal alone, which is no slope of an energy
  kWrong,   ///< with a part along the ring, of the wrong sign
  kSlope,   ///< with the right one: honest
  kRubs,    ///< the same, with viscosity along the surface: honest
  kBumps    ///< equally stiff everywhere, with small bumps of the force, as a texture has them: honest
};

template <class Derived, Soft kSoft, int kPercent>
struct Ring : hapticd::Shape {
  std::vector<double> dents;
  static constexpr auto fields() {
    return std::array{hapticd::Fields<Derived>::array("dents", &Derived::dents, "rad", 1, 0, 64, -M_PI, M_PI, "[]",
                                                      "Angles about y where the ring is softer.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    report.max_stiffness = 1000;
    report.size_m = 2 * (kRadius + kTube);
    if (kSoft == Soft::kRubs) report.flags |= HSP_R_VELOCITY;
  }

  /// Returns k [N/m] at an angle, and writes its slope over the angle.
  double stiffness(double phi, double& slope) const noexcept HSP_RT {
    double keep = 1, change = 0;
    for (const double at : dents) {
      const double a = std::remainder(phi - at, 2 * M_PI), c = M_PI * a / kWidth;
      if (std::fabs(a) >= kWidth) continue;
      const double weight = 0.5 * (1 + std::cos(c)), steep = -0.5 * std::sin(c) * M_PI / kWidth;
      change = change * (1 - weight) - keep * steep, keep *= 1 - weight;
    }
    constexpr double kPart = 0.01 * kPercent;
    slope = 500 * kPart * change;
    return 500 * (1 - kPart * (1 - keep));
  }

  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    if ((in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    const double rho = std::hypot(in.position[0], in.position[2]) + 1e-300;
    const double ux = in.position[0] / rho, uz = in.position[2] / rho, a = rho - kRadius;
    const double d = std::hypot(a, in.position[1]) + 1e-300, depth = kTube - d;
    const double n[3] = {a / d * ux, in.position[1] / d, a / d * uz}, round[3] = {uz, 0, -ux};
    for (int i = 0; i < 3; ++i) out.normal[i] = n[i], out.point[i] = in.position[i] + depth * n[i];
    out.depth_m = depth, out.flags = HSP_OUT_TRACED;
    if (depth <= 0) return HSP_OK;
    out.flags |= HSP_OUT_CONTACT;
    const double phi = std::atan2(-in.position[2], in.position[0]);
    double slope = 0;
    const double k = stiffness(phi, slope), energy = 0.5 * depth * depth * slope / rho;
    const double along = kSoft == Soft::kNormal ? 0 : kSoft == Soft::kWrong ? energy : -energy;
    const double bump = kSoft == Soft::kBumps ? 0.02 * (1 + std::sin(20 * phi)) * std::fmin(1, depth / 1e-4) : 0;
    for (int i = 0; i < 3; ++i) {
      out.force[i] = (k * depth + bump) * n[i] + along * round[i];
      if (kSoft == Soft::kRubs) out.force[i] -= 0.5 * round[i] * (in.velocity[0] * uz - in.velocity[2] * ux);
    }
    return HSP_OK;
  }
};

#define SOFT(Name, name, soft, percent, flags)                                                                  \
  struct Name : Ring<Name, soft, percent> {                                                                     \
    static constexpr hapticd::ShapeInfo kInfo{"org.example.shape." name, name, "1.0", "MIT", "A ring.", flags}; \
  };
SOFT(Softer, "softer", Soft::kNormal, 20, 0)
SOFT(SofterFlesh, "softer_flesh", Soft::kNormal, 20, HSP_C_DEFORMS)
SOFT(MuchSofter, "much_softer", Soft::kNormal, 80, 0)
SOFT(WrongSlope, "wrong_slope", Soft::kWrong, 20, 0)
SOFT(RightSlope, "right_slope", Soft::kSlope, 80, 0)
SOFT(RightSlopeRubs, "right_slope_rubs", Soft::kRubs, 80, 0)
SOFT(Bumps, "bumps", Soft::kBumps, 0, 0)

}  // namespace

HAPTICD_SHAPES(Softer, SofterFlesh, MuchSofter, WrongSlope, RightSlope, RightSlopeRubs, Bumps)
