// SPDX-License-Identifier: MIT
#include "kernels/medial/passive.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace hapticd::medial {
namespace {

using Complex = std::complex<double>;

constexpr int kAngles = 100;  ///< number of angles in half a turn that are tried
/// number of additional angles on each side of the resonance, each at half the distance of the one before
constexpr int kNarrow = 30;
constexpr int kSections = 40;  ///< golden-section steps about the greatest value
constexpr double kGolden = 0.381966;
constexpr double kNoDamping = 100;  ///< multiple of K T / 2; a greater result means that the mass has no damping

/// The loop of a sampled surface in contact, at an angle w T.
class Loop {
 public:
  Loop(const SurfaceElement& element, double dt) : contact_(element.contact), dt_(dt) {
    const ViscoelasticStep s = viscoelasticStep(element, dt);
    free_ << s.xx, s.xv, s.xy, s.vx, s.vv, s.vy, s.yx, s.yv, s.yy;
    forced_ << s.xf, s.vf, s.yf;
  }

  /// Returns the damping [N s/m] that the arm must have at this frequency.
  double need(double angle) const {
    const Complex back = std::polar(1.0, -angle);
    const Eigen::Matrix3cd left = Eigen::Matrix3cd::Identity() - back * free_.cast<Complex>();
    const Complex give = Eigen::Vector3cd(left.partialPivLu().solve(forced_.cast<Complex>()))[0];
    const Complex held = contact_ / (1.0 + 0.5 * contact_ * give * (1.0 + back));
    return 0.5 * dt_ / (1 - std::cos(angle)) * ((1.0 - back) * held).real();
  }

 private:
  double contact_, dt_;
  Eigen::Matrix3d free_;
  Eigen::Vector3d forced_;
};

/// Returns angles that are evenly spread, and others that approach the resonance of the mass between its springs.
std::vector<double> anglesOf(const SurfaceElement& e, double dt) {
  std::vector<double> all;
  for (int i = 1; i <= kAngles; ++i) all.push_back(M_PI * i / kAngles);
  const double stiff = e.contact + e.stiffness + e.branch, swing = e.mass > 0 ? std::sqrt(stiff / e.mass) * dt : 0;
  for (int i = 1; i <= kNarrow && swing > 0; ++i)
    for (const double sign : {-1.0, 1.0})
      if (const double angle = swing * (1 + sign * std::ldexp(1.0, -i)); angle < M_PI) all.push_back(angle);
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

double passiveDamping(const SurfaceElement& element, double dt) {
  if (!(element.contact > 0)) return 0;
  const Loop loop(element, dt);
  double most = -HUGE_VAL, low = 0, high = 0, before = 0;
  bool last = false;  // true if the previous angle had the greatest value so far
  for (const double angle : anglesOf(element, dt)) {
    if (last) high = angle;
    const double need = loop.need(angle);
    last = need > most;
    if (last) most = need, low = before, high = angle;
    before = angle;
  }
  for (int i = 0; i < kSections; ++i) {
    const double a = low + kGolden * (high - low), b = high - kGolden * (high - low);
    const double at_a = loop.need(a), at_b = loop.need(b);
    most = std::max({most, at_a, at_b});
    (at_a < at_b ? low : high) = at_a < at_b ? a : b;
  }
  return most < kNoDamping * 0.5 * dt * element.contact ? most : HUGE_VAL;
}

}  // namespace hapticd::medial
