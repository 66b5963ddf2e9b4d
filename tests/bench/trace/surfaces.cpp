// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <cmath>

#include "bench.hpp"

namespace hapticd::bench {
namespace {

using spline::SurfaceData;

constexpr double kSide = 0.2;  // [m]

std::vector<double> uniformKnots(int degree, int count) {
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
  for (int i = 1; i < count - degree; ++i) knots.push_back(static_cast<double>(i) / (count - degree));
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, 1.0);
  return knots;
}

SurfaceData sheet(const char* name, int degree, int count, double height, double waves) {
  SurfaceData data;
  data.name = name;
  data.degree = {degree, degree};
  data.knots = {uniformKnots(degree, count), uniformKnots(degree, count)};
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      const double x = static_cast<double>(i) / (count - 1), y = static_cast<double>(j) / (count - 1);
      const double z = height * std::sin(2 * M_PI * waves * x) * std::cos(2 * M_PI * waves * y + 0.3);
      data.points.emplace_back(kSide * (x - 0.5), kSide * (y - 0.5), z);
    }
  }
  return data;
}

constexpr double kCircle[9][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}};

double circleWeight(int i) {
  return i % 2 == 1 ? std::sqrt(0.5) : 1;
}

/// Returns the surface of revolution of a profile about z. The profile consists of quarter circles; its control points
/// are (radius from the axis, height).
SurfaceData revolution(const char* name, const std::vector<std::array<double, 2>>& profile) {
  SurfaceData data;
  data.name = name;
  data.degree = {2, 2};
  const std::vector<double> full = {0, 0, 0, .25, .25, .5, .5, .75, .75, 1, 1, 1};
  data.knots = {full, profile.size() == 9 ? full : std::vector<double>{0, 0, 0, .5, .5, 1, 1, 1}};
  for (int i = 0; i < 9; ++i) {
    for (std::size_t j = 0; j < profile.size(); ++j) {
      data.points.emplace_back(profile[j][0] * kCircle[i][0], profile[j][0] * kCircle[i][1], profile[j][1]);
      data.weights.push_back(circleWeight(i) * circleWeight(static_cast<int>(j)));
    }
  }
  return data;
}

SurfaceData sphere(double r) {
  return revolution("sphere r50", {{0, -r}, {r, -r}, {r, 0}, {r, r}, {0, r}});
}

SurfaceData torus(double ring, double tube) {
  std::vector<std::array<double, 2>> profile;
  for (const auto& corner : kCircle) profile.push_back({ring + tube * corner[0], tube * corner[1]});
  return revolution("torus 60/20", profile);
}

constexpr double kTile = 0.02;  // [m]

/// Returns one tile. Neighbouring tiles have the same control points on their common side.
SurfaceData tile(int i, int j) {
  SurfaceData data = sheet("tile", 3, 4, 0, 1);
  for (std::size_t k = 0; k < data.points.size(); ++k) {
    const double x = kTile * (i + static_cast<double>(k / 4) / 3), y = kTile * (j + static_cast<double>(k % 4) / 3);
    data.points[k] = {x, y, 0.004 * std::sin(40 * x) * std::cos(40 * y)};
  }
  return data;
}

}  // namespace

std::vector<SurfaceData> tiles(int count) {
  std::vector<SurfaceData> result;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) result.push_back(tile(i - count / 2, j - count / 2));
  return result;
}

std::vector<SurfaceData> surfaces() {
  return {sheet("bicubic 10x10", 3, 10, 0.015, 1), sphere(0.05), torus(0.06, 0.02),
          sheet("degree 5 12x12", 5, 12, 0.015, 1), sheet("ridged 48x48", 3, 48, 0.002, 5)};
}

Path contactPath(const SurfaceData& data, double step, double depth, int ticks) {
  constexpr double kMargin = 0.12;  // share of the domain that the path keeps away from sides and poles
  const spline::Surface surface(data, spline::Form::kNet);
  spline::SurfacePoint E;
  Path path;
  double u = 0.31, v = 0.42, side_u = 1, side_v = 1;
  for (int i = 0; i < ticks; ++i) {
    surface.evaluate2(u, v, E);
    const double push = depth * std::sin(0.003 * i);
    path.uv.push_back({u, v});
    path.foot.push_back(E.S);
    path.probe.push_back(E.S + push * E.Su.cross(E.Sv).normalized());
    const double angle = 0.0011 * i;
    u += side_u * step * std::cos(angle) / E.Su.norm();
    v += side_v * step * std::sin(angle) / E.Sv.norm();
    if (u < kMargin || u > 1 - kMargin) side_u = -side_u, u = std::min(std::max(u, kMargin), 1 - kMargin);
    if (v < kMargin || v > 1 - kMargin) side_v = -side_v, v = std::min(std::max(v, kMargin), 1 - kMargin);
  }
  return path;
}

}  // namespace hapticd::bench
