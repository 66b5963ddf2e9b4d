// SPDX-License-Identifier: MIT
#include "kernels/medial/layer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hapticd::medial {
namespace {

constexpr int kPoints = 24;  ///< steps along the radius of the tip
/// a layer behaves as infinitely thick if the wave number times its thickness is above this
constexpr double kDeepest = 20;
constexpr int kWavesAUnit = 16;      ///< steps per unit of the integral over wave numbers
constexpr double kLeastWave = 1e-3;  ///< for a smaller x, sinh(2x) - 2x loses all digits if nu is 1/2

/// Returns 1 minus the ratio of two compliances to a wave of pressure: that of the layer over that of a half-space.
/// @param x wave number times thickness
double missing(double x, double nu) {
  if (x < kLeastWave) {  // the first term of the series
    const double kept = 1 - nu;
    return 1 - (1 - 2 * nu) * x / (2 * kept * kept);
  }
  const double k = 3 - 4 * nu;
  // sinh and cosh from exp, which gives the same bits everywhere
  const double grows = std::exp(2 * x), shrinks = 1 / grows;
  const double above = k * (grows - shrinks) / 2 - 2 * x;
  const double below = k * (grows + shrinks) / 2 + 2 * x * x + 5 - 12 * nu + 8 * nu * nu;
  return 1 - above / below;
}

/// Abscissas and weights of Gauss-Legendre quadrature on 0 to 1.
struct Gauss {
  std::array<double, kPoints> at{}, weight{};
  Gauss() {
    for (int i = 0; i < kPoints; ++i) {
      double x = std::cos(M_PI * (i + 0.75) / (kPoints + 0.5)), slope = 1;
      for (int round = 0; round < 100; ++round) {
        double before = 1, now = x;
        for (int n = 2; n <= kPoints; ++n) {
          const double next = ((2 * n - 1) * x * now - (n - 1) * before) / n;
          before = now;
          now = next;
        }
        slope = kPoints * (x * now - before) / (x * x - 1);
        const double step = now / slope;
        x -= step;
        if (std::fabs(step) < 1e-15) break;
      }
      at[static_cast<std::size_t>(i)] = 0.5 * (1 + x);
      weight[static_cast<std::size_t>(i)] = 1 / ((1 - x * x) * slope * slope);
    }
  }
};

/// Returns kappa for a tip with a radius of `ratio` thicknesses. It solves phi(t) - 2/pi int_0^1 K(t, s) phi(s) ds = 1,
/// and kappa = int phi. K is the cosine transform of missing().
double kappa(double ratio, double nu) {
  const Gauss gauss;
  // an even number, for Simpson's rule
  const int waves = 2 * static_cast<int>(0.5 * kDeepest * kWavesAUnit * std::max(1.0, ratio));
  const double step = kDeepest / waves;
  std::vector<double> cosine(kPoints);
  Eigen::MatrixXd system = Eigen::MatrixXd::Identity(kPoints, kPoints);
  for (int w = 0; w <= waves; ++w) {  // Simpson's rule over x = wave number * thickness
    const double x = w * step, simpson = (w == 0 || w == waves ? 1 : w % 2 == 1 ? 4 : 2) * step / 3;
    const double amount = 2 / M_PI * ratio * simpson * missing(x, nu);
    for (std::size_t i = 0; i < kPoints; ++i) cosine[i] = std::cos(x * ratio * gauss.at[i]);
    for (int i = 0; i < kPoints; ++i)
      for (int j = 0; j < kPoints; ++j)
        system(i, j) -= amount * cosine[static_cast<std::size_t>(i)] * cosine[static_cast<std::size_t>(j)] *
                        gauss.weight[static_cast<std::size_t>(j)];
  }
  const Eigen::VectorXd phi = system.partialPivLu().solve(Eigen::VectorXd::Ones(kPoints));
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) sum += gauss.weight[static_cast<std::size_t>(i)] * phi[i];
  return sum;
}

}  // namespace

double layerStiffness(const ElasticLayer& layer, double tip) {
  const double half_space = 2 * layer.young * tip / (1 - layer.poisson * layer.poisson);
  return half_space * kappa(tip / layer.thickness, layer.poisson);
}

}  // namespace hapticd::medial
