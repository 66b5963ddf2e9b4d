// SPDX-License-Identifier: MIT
/// Curves and surfaces for tests, the same in every run.
#pragma once
#include <cmath>
#include <random>
#include <vector>

#include "kernels/spline/curve_data.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline::samples {

/// Clamped knots on [0, 1] with random, now and then repeated, interior knots.
inline std::vector<double> knots(int degree, int count, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.02, 0.98);
  std::vector<double> interior;
  while (static_cast<int>(interior.size()) < count - degree - 1) {
    const bool repeat = !interior.empty() && random() % 4 == 0;
    const double knot = repeat ? interior.back() : unit(random);
    const auto times = static_cast<int>(std::count(interior.begin(), interior.end(), knot));
    if (times < degree) interior.push_back(knot);
  }
  std::sort(interior.begin(), interior.end());
  std::vector<double> result(static_cast<std::size_t>(degree) + 1, 0.0);
  result.insert(result.end(), interior.begin(), interior.end());
  result.insert(result.end(), static_cast<std::size_t>(degree) + 1, 1.0);
  return result;
}

/// A wavy sheet of about 0.2 m; weights from 1/spread to spread, spread 0: polynomial.
inline SurfaceData sheet(std::array<int, 2> degree, std::array<int, 2> count, double spread, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-1, 1);
  SurfaceData data;
  data.name = "sheet";
  data.degree = degree;
  data.knots = {knots(degree[0], count[0], random), knots(degree[1], count[1], random)};
  for (int i = 0; i < count[0]; ++i) {
    for (int j = 0; j < count[1]; ++j) {
      data.points.emplace_back(0.2 * (i + 0.3 * noise(random)) / count[0], 0.2 * (j + 0.3 * noise(random)) / count[1],
                               0.02 * noise(random));
      if (spread > 0) data.weights.push_back(std::pow(spread, noise(random)));
    }
  }
  return data;
}

/// The nine-point circle in (x, y) of unit radius, as points and weights.
inline constexpr double kCircle[9][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
inline double circleWeight(int i) {
  return i % 2 == 1 ? std::sqrt(0.5) : 1;
}
inline std::vector<double> circleKnots() {
  return {0, 0, 0, .25, .25, .5, .5, .75, .75, 1, 1, 1};
}

/// A sphere about the origin: u runs around, v from the south pole to the north pole.
inline SurfaceData sphere(double radius) {
  SurfaceData data;
  data.name = "sphere";
  data.degree = {2, 2};
  data.knots = {circleKnots(), {0, 0, 0, .5, .5, 1, 1, 1}};
  constexpr double kMeridian[5][2] = {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}};
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 5; ++j) {
      data.points.emplace_back(radius * kMeridian[j][0] * kCircle[i][0], radius * kMeridian[j][0] * kCircle[i][1],
                               radius * kMeridian[j][1]);
      data.weights.push_back(circleWeight(i) * circleWeight(j));
    }
  }
  return data;
}

/// A torus about the z axis.
inline SurfaceData torus(double ring, double tube) {
  SurfaceData data;
  data.name = "torus";
  data.degree = {2, 2};
  data.knots = {circleKnots(), circleKnots()};
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      const double radius = ring + tube * kCircle[j][0];
      data.points.emplace_back(radius * kCircle[i][0], radius * kCircle[i][1], tube * kCircle[j][1]);
      data.weights.push_back(circleWeight(i) * circleWeight(j));
    }
  }
  return data;
}

/// Two planes of slope `slope` that meet at u = 0.5 under a knot of multiplicity p: a roof.
inline SurfaceData roof(double slope) {
  SurfaceData data;
  data.name = "roof";
  data.degree = {3, 3};
  data.knots = {std::vector<double>{0, 0, 0, 0, .5, .5, .5, 1, 1, 1, 1}, std::vector<double>{0, 0, 0, 0, 1, 1, 1, 1}};
  for (int i = -3; i <= 3; ++i) {
    for (int j = 0; j < 4; ++j) data.points.emplace_back(i / 3.0, j / 3.0, -slope * std::abs(i) / 3.0);
  }
  return data;
}

}  // namespace hapticd::spline::samples
