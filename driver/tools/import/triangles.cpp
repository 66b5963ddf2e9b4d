// SPDX-License-Identifier: MIT
#include "import/triangles.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <map>

namespace hapticd::importing {

namespace {

/// Returns why no body can be made of a surface. @param first [m] middle of the first wrong edge
std::string notClosed(const std::string& file, std::size_t edges, const Eigen::Vector3d& first) {
  char text[320];
  std::snprintf(text, sizeof text,
                ": the surface is not closed: %zu edge%s at a hole, or %s triangles turned against each other, the "
                "first at (%.4g, %.4g, %.4g) m; expected a closed surface\n  fix: close it in the program that made "
                "it; without --medial, import lists the holes: hapticd import ",
                edges, edges == 1 ? " is" : "s are", edges == 1 ? "has" : "have", first.x(), first.y(), first.z());
  return file + text + file + " -o part.hpart";
}

}  // namespace

Result<void> orientClosed(Triangles& mesh, const std::string& file) {
  std::map<std::array<uint32_t, 2>, int> directed;
  for (const auto& c : mesh.corners)
    for (std::size_t k = 0; k < 3; ++k) ++directed[{c[k], c[(k + 1) % 3]}];
  std::size_t open = 0;
  Eigen::Vector3d first(0, 0, 0);
  for (const auto& [edge, count] : directed) {
    const auto back = directed.find({edge[1], edge[0]});
    if (count == 1 && back != directed.end() && back->second == 1) continue;
    if (open++ == 0) first = 0.5 * (mesh.points[edge[0]] + mesh.points[edge[1]]);
  }
  if (open > 0) return Error{notClosed(file, open, first)};
  double volume = 0;
  for (const auto& c : mesh.corners) volume += mesh.points[c[0]].dot(mesh.points[c[1]].cross(mesh.points[c[2]])) / 6;
  if (!(std::fabs(volume) > 0))
    return Error{file + ": the surface encloses no volume; expected a closed surface that is not flat"};
  if (volume < 0)
    for (auto& c : mesh.corners) std::swap(c[1], c[2]);
  return {};
}

}  // namespace hapticd::importing
