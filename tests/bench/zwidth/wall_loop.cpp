// SPDX-License-Identifier: MIT
#include "wall_loop.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/contact/wall.hpp"
#include "servo/velocity/estimator.hpp"

namespace hapticd::zwidth {
namespace {

using Eigen::MatrixXd;

/// Calculates exp(rates) by its series, with scaling and squaring. Eigen's function takes seconds to compile.
Eigen::Matrix3d exponential(Eigen::Matrix3d rates) {
  int halvings = 0;
  for (; rates.norm() > 0.25; ++halvings) rates /= 2;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity(), term = sum;
  for (int i = 1; i <= 12; ++i) {
    term = (term * rates / i).eval();
    sum += term;
  }
  for (; halvings > 0; --halvings) sum = (sum * sum).eval();
  return sum;
}

/// Returns the matrix that maps (x, v, force) to x and v one period later, if the force is held.
Eigen::Matrix<double, 2, 3> heldStep(const Body& body, double period) {
  Eigen::Matrix3d rates = Eigen::Matrix3d::Zero();
  rates(0, 1) = 1;
  rates.row(1) << -body.hand_spring / body.mass, -body.damping / body.mass, 1 / body.mass;
  const Eigen::Matrix3d over = exponential(rates * period);
  return over.topRows<2>();
}

double quantised(double x, double step) {
  return step > 0 ? std::round(x / step) * step : x;
}

/// Returns the largest stiffness for which `holds` is true, by bisection on a logarithmic scale; 0 if it is false for
/// `from`.
template <class Holds>
double largest(double from, double to, const Holds& holds) {
  constexpr int kHalvings = 44;
  if (!holds(from)) return 0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(from * to);
    (holds(middle) ? from : to) = middle;
  }
  return from;
}

}  // namespace

double spectralRadius(const Wall& wall, const Body& body) {
  // State: x, v, then the samples x_(k-1) ... x_(k-d-n).
  const int past = wall.delay + (wall.damping != 0 ? wall.window : 0);
  const Eigen::Matrix<double, 2, 3> step = heldStep(body, wall.period);
  Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(2 + past);
  const auto sample = [&](int age) { return age == 0 ? 0 : 1 + age; };
  const double rate = wall.damping / (wall.window * wall.period);
  force[sample(wall.delay)] -= wall.stiffness + rate;
  if (wall.damping != 0) force[sample(wall.delay + wall.window)] += rate;
  MatrixXd loop = MatrixXd::Zero(2 + past, 2 + past);
  loop.topLeftCorner<2, 2>() = step.leftCols<2>();
  loop.topRows<2>() += step.col(2) * force;
  if (past > 0) loop(2, 0) = 1;
  for (int i = 1; i < past; ++i) loop(2 + i, 1 + i) = 1;
  return loop.eigenvalues().cwiseAbs().maxCoeff();
}

double stableStiffness(Wall wall, const Body& body, double from, double to) {
  return largest(from, to, [&](double stiffness) {
    wall.stiffness = stiffness;
    return spectralRadius(wall, body) < 1;
  });
}

double stableStiffnessWorstHand(Wall wall, const Body& device) {
  // A hand is described by its mass and by its natural frequency, as the phase theta [rad] per sample. Light hands move
  // most. The loop may be unstable in an interval of stiffness only, so a scan finds this interval before the
  // bisection.
  double least = std::numeric_limits<double>::infinity();
  for (const double load : {1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0, 1000.0}) {
    for (double theta = 0.05; theta <= 3.2; theta += theta < 0.5 ? 0.05 : 0.1) {
      Body body = device;
      body.mass = load * device.damping * wall.period;
      body.hand_spring = body.mass * std::pow(theta / wall.period, 2);
      wall.stiffness = 1e-9;
      if (spectralRadius(wall, body) >= 1) return 0;
      double low = 0.05 * device.damping / wall.period;
      for (double k = low; k < std::min(least, 4 * device.damping / wall.period + 4 * wall.damping / wall.period);
           low = k, k *= 1.05) {
        wall.stiffness = k;
        if (spectralRadius(wall, body) < 1) continue;
        least = std::min(least, stableStiffness(wall, body, low, k));
        break;
      }
    }
  }
  return least;
}

double zigzagEnergy(const Wall& wall, const Body& device, double center, double amplitude, int samples) {
  const contact::WallLaw law{wall.stiffness, 0, 1, 1e-3};
  const double leg = 2 * amplitude / samples, speed = leg / wall.period;
  double energy = 0;
  for (int i = 0; i < 2 * samples; ++i) {
    const double along = i < samples ? i * leg : (2 * samples - i) * leg;
    const double way = i < samples ? leg : -leg;  // the first half goes deeper
    const double seen = quantised(center - amplitude + along, wall.resolution);
    energy += contact::wallForce(law, seen, 0).force * way;
    energy += (device.damping * speed + device.friction) * std::abs(way);
  }
  return energy;
}

double worstZigzagEnergy(const Wall& wall, const Body& device) {
  const double unit = wall.resolution > 0 ? wall.resolution : 1e-5;
  double worst = std::numeric_limits<double>::infinity();
  for (const int samples : {1, 2, 3})
    for (double amplitude = 1e-4 * unit; amplitude < 1e4 * unit; amplitude *= 1.3)
      for (const double shift : {0.0, 0.25, 0.5}) {
        const double center = (std::ceil(amplitude / unit) + 10 + shift) * unit;
        const double scale = amplitude * amplitude + amplitude * unit;
        worst = std::min(worst, zigzagEnergy(wall, device, center, amplitude, samples) / scale);
      }
  return worst;
}

double passiveStiffness(Wall wall, const Body& device) {
  return largest(1e-3, 1e9, [&](double stiffness) {
    wall.stiffness = stiffness;
    return worstZigzagEnergy(wall, device) >= -1e-9 * stiffness;
  });
}

double sinusoidEnergy(const Wall& wall, const Body& device, double theta) {
  const int settle = wall.window + wall.delay + 1;
  const int samples = static_cast<int>(std::ceil(400 * 2 * M_PI / theta));
  auto estimator = velocity::make("window", wall.window, 1 / wall.period);
  std::vector<double> force, x;
  for (int k = 0; k <= settle + samples; ++k) {
    x.push_back(std::cos(theta * k));
    const Eigen::Vector3d v = estimator.update(Eigen::Vector3d(x.back(), 0, 0), k == 0 ? 0 : wall.period);
    force.push_back(wall.stiffness * x.back() + wall.damping * v.x());
  }
  double energy = 0, window = 0;
  for (int k = settle; k < settle + samples; ++k) {
    // A Hann window over the whole run, so that an incomplete period has little weight.
    const double weight = 1 - std::cos(2 * M_PI * (k - settle + 0.5) / samples);
    const double way = x[static_cast<size_t>(k) + 1] - x[static_cast<size_t>(k)];
    energy += weight * (force[static_cast<size_t>(k - wall.delay)] + device.damping * way / wall.period) * way;
    window += weight;
  }
  return energy / window;
}

double restitution(const Wall& wall, double mass) {
  constexpr int kPhases = 2000;
  const contact::WallLaw law{wall.stiffness, 0, 1, 1e-3};
  double largest_ratio = 0;
  for (int phase = 0; phase < kPhases; ++phase) {
    // the mass reaches the wall within the first period, at a time that depends on the phase
    double x = -(phase + 0.5) / kPhases * wall.period, v = 1;
    for (int i = 0; i < 1'000'000 && !(x < 0 && v < 0); ++i) {
      const double a = -contact::wallForce(law, x, 0).force / mass;
      x += v * wall.period + a * wall.period * wall.period / 2;
      v += a * wall.period;
    }
    largest_ratio = std::max(largest_ratio, -v);
  }
  return largest_ratio;
}

}  // namespace hapticd::zwidth
