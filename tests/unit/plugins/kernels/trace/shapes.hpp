// SPDX-License-Identifier: MIT
/// Models of config/models and their closed forms, and random patches.
#pragma once
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "kernels/trace/model.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::trace {

inline Model solid(const std::string& name) {
  const ModelFile file = readModelFile(HAPTICD_SOURCE_DIR "/config/models/" + name + ".yaml");
  ModelOptions options;
  options.edges = file.edges;
  return Model(file.surfaces, options);
}

/// Signed distance [m] of the solid `name`, positive outside.
inline double signedDistance(const std::string& name, const Eigen::Vector3d& p) {
  const double r = std::hypot(p.x(), p.z());
  if (name == "sphere") return p.norm() - 0.05;
  if (name == "torus") return std::hypot(r - 0.05, p.y()) - 0.02;
  if (name == "box") {
    const Eigen::Vector3d q = p.cwiseAbs() - Eigen::Vector3d::Constant(0.05);
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
  }
  const double aside = r - 0.04, above = std::abs(p.y()) - 0.05;  // cylinder
  return std::hypot(std::max(aside, 0.0), std::max(above, 0.0)) + std::min(std::max(aside, above), 0.0);
}

/// Turns a curve about the y axis. @param profile radius, y and weight of the control points [m]
inline spline::SurfaceData turned(const std::vector<std::array<double, 3>>& profile) {
  const double w = std::sqrt(0.5);
  const std::array<std::array<double, 3>, 9> circle{
      {{1, 0, 1}, {1, 1, w}, {0, 1, 1}, {-1, 1, w}, {-1, 0, 1}, {-1, -1, w}, {0, -1, 1}, {1, -1, w}, {1, 0, 1}}};
  spline::SurfaceData data;
  data.degree = {2, static_cast<int>(profile.size()) - 1};
  data.knots[0] = {0, 0, 0, .25, .25, .5, .5, .75, .75, 1, 1, 1};
  data.knots[1].assign(profile.size(), 0);
  data.knots[1].insert(data.knots[1].end(), profile.size(), 1);
  for (const auto& [z, x, weight] : circle)
    for (const auto& [radius, y, own] : profile) {
      data.points.emplace_back(radius * x, y, radius * z);
      data.weights.push_back(weight * own);
    }
  return data;
}

/// Two plates of 50 mm that meet on the z axis at an angle [rad], as one cubic surface with simple knots: three rows of
/// its control points coincide at the fold.
inline spline::SurfaceData foldedByACusp(double angle) {
  const double x = 0.05 * std::sin(angle / 2), y = -0.05 * std::cos(angle / 2);
  spline::SurfaceData data;
  data.degree = {3, 1};
  data.knots = {{{0, 0, 0, 0, .25, .5, .75, 1, 1, 1, 1}, {0, 0, 1, 1}}};
  for (const double share : {-1.0, -0.6, 0.0, 0.0, 0.0, 0.6, 1.0})
    for (const double z : {0.05, -0.05}) data.points.emplace_back(x * share, y * std::abs(share), z);
  return data;
}

/// A bicubic patch of 100 mm with random bumps, on a random knot vector.
inline spline::SurfaceData randomPatch(std::mt19937& random, int count = 8, bool rational = false) {
  std::uniform_real_distribution<double> bump(-0.008, 0.008), span(0.5, 1.5), weight(0.5, 2);
  spline::SurfaceData data;
  data.degree = {3, 3};
  for (auto& knots : data.knots) {
    knots.assign(4, 0);
    for (int i = 4; i < count; ++i) knots.push_back(knots.back() + span(random));
    knots.insert(knots.end(), 4, knots.back() + span(random));
  }
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      data.points.emplace_back(0.1 * i / (count - 1), 0.1 * j / (count - 1), bump(random));
      if (rational) data.weights.push_back(weight(random));
    }
  return data;
}

}  // namespace hapticd::trace
