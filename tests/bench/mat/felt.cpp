// SPDX-License-Identifier: MIT
/// Measures felt surfaces: how near the sampled tissue is to continuous tissue, and how stiff it may be on an arm.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "bench.hpp"
#include "felt_bodies.hpp"
#include "kernels/medial/passive.hpp"

namespace hapticd::bench_mat {
namespace {

using medial::SurfaceElement;
using medial::Tissue;

constexpr double kRates[] = {1000, 2000, 4000};
/// multiple of the stiffness: with more, the measuring probe would lose contact (mean depth over amplitude, less a
/// margin)
constexpr double kLoses = 8;
constexpr double kArmDamping = 0.1;  ///< [N s/m]

struct Named {
  const char* name;
  Tissue tissue;
};
std::vector<Named> tissues() {
  return {{"200 N/m, 0.6 N s/m, 10 g (the plate)", {200, .6, .01, 0, 0}},
          {"the same, relaxing by 0.8 in 0.3 s", {200, .6, .01, .8, .3}},
          {"200 N/m, 0.1 N s/m, no mass", {200, .1, 0, 0, 0}},
          {"200 N/m, 5 N s/m, 10 g", {200, 5, .01, 0, 0}}};
}

std::string moduli() {
  std::string text =
      "| tissue | frequency | storage | loss | error at 1 kHz | at 2 kHz | at 4 kHz |\n|---|---|---|---|---|---|---|\n";
  for (const auto& [name, tissue] : {tissues()[0], tissues()[1]}) {
    const SurfaceElement element = medial::elementOf(tissue, medial::test::kRatio);
    for (const double hertz : {.1, 1.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
      const std::complex<double> truth = medial::test::impedance(element, 2 * M_PI * hertz);
      text += fmt::format("| {} | {:g} Hz | {:.1f} N/m | {:.1f} N/m |", name, hertz, truth.real(), truth.imag());
      if (std::abs(truth) > kLoses * tissue.stiffness) {
        text += " it loses contact | | |\n";
        continue;
      }
      for (const double rate : kRates)
        text += fmt::format(
            " {:.2g} % |",
            100 * std::abs(medial::test::measuredImpedance(tissue, hertz, 1 / rate) - truth) / std::abs(truth));
      text += "\n";
    }
  }
  return text + "\n";
}

/// Hand and arm at the surface, as a damped mass on a spring [kg, N s/m, N/m].
struct Load {
  double mass = 0.075, damping = kArmDamping, spring = 0;
};

/// Returns the spectral radius of the sampled loop in contact, over one tick. The state is: position q and speed of the
/// probe; x, v and y of the surface; q one tick ago.
double spectralRadius(const SurfaceElement& e, const Load& load, double dt) {
  using Matrix = Eigen::Matrix<double, 6, 6>;
  const medial::ViscoelasticStep s = medial::viscoelasticStep(e, dt);
  Eigen::Matrix3d rates = Eigen::Matrix3d::Zero();
  rates(0, 1) = 1;
  rates.row(1) << -load.spring / load.mass, -load.damping / load.mass, 1 / load.mass;
  const Eigen::Matrix3d held = (rates * dt).exp();
  const double half = 0.5 * e.contact;
  Eigen::Matrix<double, 1, 6> mean;  // mean force of the contact over the tick that ends now
  mean << half, 0, -half * (1 + s.xx), -half * s.xv, -half * s.xy, half;
  mean /= 1 + half * s.xf;
  Matrix now = Matrix::Zero();
  now.row(2) << 0, 0, s.xx, s.xv, s.xy, 0;
  now.row(3) << 0, 0, s.vx, s.vv, s.vy, 0;
  now.row(4) << 0, 0, s.yx, s.yv, s.yy, 0;
  now.row(2) += s.xf * mean, now.row(3) += s.vf * mean, now.row(4) += s.yf * mean;
  Eigen::Matrix<double, 1, 6> force = e.contact * now.row(2);
  force[0] -= e.contact;
  now.topLeftCorner<2, 2>() = held.topLeftCorner<2, 2>();
  now.row(0) += held(0, 2) * force;
  now.row(1) += held(1, 2) * force;
  now(5, 0) = 1;
  return now.eigenvalues().cwiseAbs().maxCoeff();
}

/// Returns the element of a tissue that is scaled so that its contact spring has the stiffness `contact` [N/m]. Its
/// time constants stay the same.
SurfaceElement scaled(const Tissue& tissue, double contact, double dt) {
  const double by = contact / medial::elementOf(tissue, medial::test::kRatio).contact;
  Tissue stiff = tissue;
  stiff.stiffness *= by, stiff.damping *= by, stiff.mass *= by;
  return medial::dampedForTick(medial::elementOf(stiff, medial::test::kRatio), dt);
}

/// Returns the stiffness [N/m] of the contact spring up to which the loop is stable with each of the loads, by a scan
/// in steps of 2 %.
double stiffest(const Tissue& tissue, const std::vector<Load>& loads, double dt) {
  double least = 1e6;
  for (const Load& load : loads) {
    for (double contact = 10; contact < least; contact *= 1.02) {
      if (spectralRadius(scaled(tissue, contact, dt), load, dt) < 1) continue;
      least = contact;
      break;
    }
  }
  return least;
}

/// Returns the largest stiffness [N/m] of the contact spring that is passive on the arm, whatever hand holds it.
double passiveUpTo(const Tissue& tissue, double dt) {
  double low = 1, high = 1e6;
  while (high > 1.001 * low) {
    const double contact = std::sqrt(low * high);
    (medial::passiveDamping(scaled(tissue, contact, dt), dt) <= kArmDamping ? low : high) = contact;
  }
  return low;
}

/// Returns hands of mass and spring without friction, with natural frequencies up to half the sampling rate.
std::vector<Load> worstHands(double dt) {
  std::vector<Load> all;
  for (const double weight : {1e-2, 1e-1, 1.0, 10.0, 100.0})
    for (double theta = 0.05; theta <= 3.2; theta += theta < 0.5 ? 0.05 : 0.15) {
      const double mass = weight * kArmDamping * dt;
      all.push_back({mass, kArmDamping, mass * std::pow(theta / dt, 2)});
    }
  return all;
}

std::string zWidth() {
  std::string text =
      "| tissue | rate | 2 b / T | bound | found, worst hand | felt stiffness there | arm of 75 g alone |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const auto& [name, tissue] : tissues()) {
    for (const double rate : kRates) {
      const double dt = 1 / rate, worst = stiffest(tissue, worstHands(dt), dt);
      const double ratio = medial::elementOf(tissue, medial::test::kRatio).contact / tissue.stiffness;
      text += fmt::format("| {} | {:g} Hz | {:.0f} N/m | {:.0f} N/m | {:.0f} N/m | {:.0f} N/m | {:.0f} N/m |\n", name,
                          rate, 2 * kArmDamping * rate, passiveUpTo(tissue, dt), worst, worst / ratio,
                          stiffest(tissue, {{}}, dt));
    }
  }
  return text + "\n";
}

}  // namespace

std::string feltTables() {
  return "## Felt surfaces\n\nStorage and loss modulus of one place (force over motion, in and out of phase) as a "
         "probe "
         "feels them that moves up and down, beside the continuous tissue: the error is the distance in the complex "
         "plane over the modulus. It falls by four for each doubling of the rate.\n\n" +
         moduli() +
         "Z-width: the stiffest contact spring (`contact_ratio` times a fast press's stiffness) on an arm of b = 0.1 N "
         "s/m, by the eigenvalues of the whole sampled loop of arm, hand and surface; the force is held for a tick. "
         "2 b / T is the bound of a wall of the contact's stiffness; *bound* is that of the surface itself, which "
         "`hapticd explain` prints: behind the contact a mass resonates. Tissue is scaled with its times kept.\n\n" +
         zWidth();
}

}  // namespace hapticd::bench_mat
