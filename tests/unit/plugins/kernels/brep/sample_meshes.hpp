// SPDX-License-Identifier: MIT
/// Meshes made by hand, for tests.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "sample_parts.hpp"

namespace hapticd::brep::samples {

/// Returns a part with one mesh. @param corners point indices of each triangle
inline Part meshOf(std::vector<Vector> points, const std::vector<std::array<std::uint32_t, 3>>& corners) {
  Part part;
  part.points = std::move(points);
  for (const auto& corner : corners) {
    Triangle triangle;
    triangle.corner = corner;
    part.triangles.push_back(triangle);
  }
  Body body;
  body.kind = BodyKind::kMesh;
  body.point_count = static_cast<std::uint32_t>(part.points.size());
  body.triangle_count = static_cast<std::uint32_t>(part.triangles.size());
  part.bodies.push_back(body);
  Instance instance;
  instance.body = 0;
  part.instances.push_back(instance);
  return part;
}

/// Returns a wavy sheet of 100 mm x 100 mm with 2 n^2 triangles. @param height [m] amplitude of the waves
inline Part sheet(std::uint32_t n, double height) {
  std::vector<Vector> points;
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= n; ++j) {
      const double x = 0.1 * i / n, y = 0.1 * j / n;
      points.push_back({x, y, height * std::sin(200 * x) * std::cos(170 * y)});
    }
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      corners.push_back({a, b, b + 1});
      corners.push_back({a, b + 1, a + 1});
    }
  return meshOf(std::move(points), corners);
}

/// Returns triangles of many sizes and shapes. Some are needles, and some are single points.
inline Part scatteredTriangles(std::mt19937& random) {
  std::uniform_real_distribution<double> share(-1, 1), exponent(-9, 0);
  std::vector<Vector> points;
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const double size = std::pow(10, -2 + 0.5 * exponent(random));
    const Eigen::Vector3d at = 0.05 * Eigen::Vector3d(share(random), share(random), share(random));
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d p =
          at + size * Eigen::Vector3d(share(random), share(random), i % 5 == 0 ? 0 : share(random));
      points.push_back(i % 50 == 0 ? Vector{at.x(), at.y(), at.z()} : Vector{p.x(), p.y(), p.z()});
    }
    corners.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return meshOf(std::move(points), corners);
}

/// The corners [m] of triangles, counter-clockwise seen from outside.
using TriangleList = std::vector<std::array<Eigen::Vector3d, 3>>;

/// Returns a ball of radius 1 m about the origin, of 512 triangles: an octahedron whose edges were halved three times.
inline TriangleList unitBall() {
  TriangleList mesh;
  for (const double x : {-1, 1})
    for (const double y : {-1, 1})
      for (const double z : {-1, 1}) {
        const Eigen::Vector3d a(x, 0, 0), b(0, y, 0), c(0, 0, z);
        mesh.push_back(x * y * z > 0 ? std::array{a, b, c} : std::array{a, c, b});
      }
  for (int round = 0; round < 3; ++round) {
    TriangleList fine;
    for (const auto& [a, b, c] : mesh) {
      const Eigen::Vector3d ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      fine.insert(fine.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh = fine;
  }
  return mesh;
}

/// Returns the closed part of a mesh whose triangles share corners with the same numbers.
inline Part partOf(const TriangleList& mesh) {
  Part part;
  std::map<std::array<double, 3>, std::uint32_t> points;
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> sides;  // the side of a triangle from one point to another
  for (const auto& corners : mesh) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = corners[k];
      const auto [found, added] =
          points.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(part.points.size()));
      if (added) part.points.push_back({p.x(), p.y(), p.z()});
      t.corner[k] = found->second;
    }
    for (std::uint32_t k = 0; k < 3; ++k)
      sides[{t.corner[k], t.corner[(k + 1) % 3]}] = 4 * static_cast<std::uint32_t>(part.triangles.size()) + k;
    part.triangles.push_back(t);
  }
  for (Triangle& t : part.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto found = sides.find({t.corner[(k + 1) % 3], t.corner[k]}); found != sides.end())
        t.across[k] = found->second;
  endBody(part, BodyKind::kMesh, kClosed);
  return part;
}

}  // namespace hapticd::brep::samples
