// SPDX-License-Identifier: MIT
/// Meshes made by hand, for tests.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <tuple>
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

/// Tells each triangle which one is beyond each of its edges. Those around an edge form a ring.
inline void joinTriangles(Part& part) {
  std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> sides;  // two points, and the side between them
  for (std::uint32_t t = 0; t < part.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto& corner = part.triangles[t].corner;
      const auto [low, high] = std::minmax(corner[k], corner[(k + 1) % 3]);
      sides.emplace_back(low, high, 4 * t + k);
    }
  std::sort(sides.begin(), sides.end());
  const auto sameEdge = [&](std::size_t i, std::size_t j) {
    return std::get<0>(sides[i]) == std::get<0>(sides[j]) && std::get<1>(sides[i]) == std::get<1>(sides[j]);
  };
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
    while (end < sides.size() && sameEdge(first, end)) ++end;
    for (std::size_t i = first; end - first > 1 && i < end; ++i) {
      const std::uint32_t code = std::get<2>(sides[i]);
      part.triangles[code / 4].across[code % 4] = std::get<2>(sides[i + 1 < end ? i + 1 : first]);
    }
  }
}

/// Returns a mesh whose triangles know their neighbours.
inline Part joined(Part part) {
  joinTriangles(part);
  return part;
}

/// Returns a closed ball with a radius of 50 mm and with bumps. @param triangles approximate number of triangles
inline Part bumpyBall(int triangles) {
  const auto n = static_cast<std::uint32_t>(std::sqrt(triangles / 4.0)), m = 2 * n;
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    if (i == 0) return 0u;
    return i == n ? 1u : 2 + (i - 1) * m + j % m;
  };
  std::vector<Vector> points{{0, 0, 0.05}, {0, 0, -0.05}};
  for (std::uint32_t i = 1; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      const double a = std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m;
      const double r = 0.05 + 0.003 * std::sin(5 * a) * std::cos(7 * b) * std::sin(a) * std::sin(a);
      points.push_back({r * std::sin(a) * std::cos(b), r * std::sin(a) * std::sin(b), r * std::cos(a)});
    }
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      if (i < n - 1) corners.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (i > 0) corners.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  Part part = joined(meshOf(std::move(points), corners));
  part.bodies[0].flags = kClosed;
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
