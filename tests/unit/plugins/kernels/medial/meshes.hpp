// SPDX-License-Identifier: MIT
/// Medial meshes for tests.
#pragma once
#include <random>

#include "kernels/medial/medial_mesh.hpp"

namespace hapticd::medial::test {

/// Three branches of 40 mm in a plane, radius 10 mm where they meet and 6 mm at their ends, 8 cones each.
inline MeshData branches() {
  MeshData mesh;
  mesh.vertices.push_back({{0, 0, 0}, .01});
  for (const double angle : {0.5, 2.6, -1.57}) {
    const Eigen::Vector3d along(std::cos(angle), std::sin(angle), 0);
    for (int i = 1; i <= 8; ++i) {
      const int here = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back({.005 * i * along, .01 - .0005 * i});
      mesh.edges.push_back({i == 1 ? 0 : here - 1, here});
    }
  }
  return mesh;
}

/// A sheet of n x n vertices, 100 x 100 mm, domed; its radius varies about 8 mm.
inline MeshData sheet(int n) {
  MeshData mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double s = i / (n - 1.0), t = j / (n - 1.0);
      mesh.vertices.push_back({{.1 * s, .1 * t, .03 * (s * (1 - s) + t * (1 - t))}, .008 + .002 * std::sin(5 * s + t)});
    }
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int a = i * n + j;
      mesh.triangles.push_back({a, a + n, a + n + 1});
      mesh.triangles.push_back({a, a + n + 1, a + 1});
    }
  return mesh;
}

/// A hollow ball of 50 mm, 4 mm thick each way: 2 n^2 slabs, but for those that meet at its poles.
inline MeshData ball(int n) {
  MeshData mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double a = 2 * M_PI * i / n, b = M_PI * j / n;
      mesh.vertices.push_back(
          {{.05 * std::cos(a) * std::sin(b), .05 * std::sin(a) * std::sin(b), .05 * std::cos(b)}, .004});
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = ((i + 1) % n) * (n + 1) + j;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return mesh;
}

/// Spheres of any size joined at random: nested ones, thin triangles, crossing slabs.
inline MeshData tangle(unsigned seed, int vertices, int edges, int triangles) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto pick = [&] { return static_cast<int>(engine() % static_cast<unsigned>(vertices)); };
  MeshData mesh;
  for (int i = 0; i < vertices; ++i) {
    const double x = unit(engine), y = unit(engine), z = unit(engine), r = unit(engine);
    mesh.vertices.push_back({{.1 * x, .1 * y, .1 * z}, r * r * r * .06});
  }
  while (static_cast<int>(mesh.edges.size()) < edges) {
    const int a = pick(), b = pick();
    if (a != b) mesh.edges.push_back({a, b});
  }
  while (static_cast<int>(mesh.triangles.size()) < triangles) {
    const int a = pick(), b = pick(), c = pick();
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  }
  return mesh;
}

}  // namespace hapticd::medial::test
