// SPDX-License-Identifier: MIT
/// Finds the vertices where a medial mesh ends.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>

#include "kernels/medial/soft_weights.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

constexpr double kStraight = 0.9397;  ///< cosine of 20 degrees; a smaller bend is smooth, as in `hapticd import`

/// The elements that meet at an edge or a vertex, by their directions toward it: in the plane of a slab, or along a
/// cone.
struct Join {
  std::size_t count = 0;
  std::array<Vector3d, 2> into{Vector3d::Zero(), Vector3d::Zero()};

  void add(const Vector3d& direction) {
    if (count < 2) into[count] = direction;
    ++count;
  }
  bool ends() const { return count != 2 || into[0].dot(into[1]) > -kStraight; }
};

Vector3d unitOrZero(const Vector3d& v) {
  const double length = v.norm();
  return length > 0 ? Vector3d(v / length) : Vector3d(Vector3d::Zero());
}

}  // namespace

std::vector<uint8_t> endsOf(const MedialMesh& mesh) {
  std::map<std::array<uint32_t, 2>, Join> edges;
  std::vector<Join> tips(mesh.vertices().size());
  std::vector<uint8_t> in_slab(mesh.vertices().size(), 0), ends(mesh.vertices().size(), 0);
  const auto center = [&mesh](uint32_t vertex) -> const Vector3d& { return mesh.vertices()[vertex].center; };
  for (const MedialMesh::Element& element : mesh.elements()) {
    for (std::size_t i = 0; element.count == 3 && i < 3; ++i) {
      const uint32_t a = element.vertex[i], b = element.vertex[(i + 1) % 3], c = element.vertex[(i + 2) % 3];
      const Vector3d along = unitOrZero(center(b) - center(a)), inside = center(c) - center(a);
      edges[{std::min(a, b), std::max(a, b)}].add(unitOrZero(inside - inside.dot(along) * along));
      in_slab[a] = 1;
    }
    for (std::size_t i = 0; element.count == 2 && i < 2; ++i)
      tips[element.vertex[i]].add(unitOrZero(center(element.vertex[1 - i]) - center(element.vertex[i])));
  }
  for (const auto& [edge, join] : edges)
    if (join.ends()) ends[edge[0]] = ends[edge[1]] = 1;
  for (std::size_t v = 0; v < tips.size(); ++v)
    if (tips[v].count > 0 && (in_slab[v] != 0 || tips[v].ends())) ends[v] = 1;
  return ends;
}

}  // namespace hapticd::medial
