// SPDX-License-Identifier: MIT
#include "kernels/brep/model/open_borders.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

#include "kernels/brep/geometry/geometry.hpp"
#include "kernels/brep/model/groups.hpp"

namespace hapticd::brep {
namespace {

/// Groups free edges that share an end.
class Chains {
 public:
  /// @param ends number of points or vertices at which edges can end
  explicit Chains(std::size_t ends) : joined_(ends) {}

  /// Adds an edge. An end of kNone is that of an edge that is closed in itself.
  void add(std::uint32_t from, std::uint32_t to, std::uint32_t body, const Eigen::AlignedBox3d& box) {
    if (from == kNone) from = joined_.add();
    if (to == kNone) to = from;
    joined_.join(from, to);
    edges_.push_back({from, {1, body, box}});
  }

  std::vector<OpenBorder> borders() {
    std::map<std::uint32_t, OpenBorder> of_root;
    for (const auto& [end, edge] : edges_) {
      const auto [known, is_new] = of_root.try_emplace(joined_.rootOf(end), edge);
      if (is_new) continue;
      known->second.edges += 1;
      known->second.box.extend(edge.box);
    }
    std::vector<OpenBorder> all;
    for (const auto& [root, border] : of_root) all.push_back(border);
    std::stable_sort(all.begin(), all.end(), [](const OpenBorder& a, const OpenBorder& b) {
      return a.body != b.body ? a.body < b.body : a.box.diagonal().squaredNorm() > b.box.diagonal().squaredNorm();
    });
    return all;
  }

 private:
  Groups joined_;  ///< the ends
  std::vector<std::pair<std::uint32_t, OpenBorder>> edges_;
};

/// Returns the pose of each body's only instance; no move if it has several, since then no place is that of all.
std::vector<Eigen::Affine3d> onlyPoses(const Part& part) {
  std::vector<Eigen::Affine3d> poses(part.bodies.size(), Eigen::Affine3d::Identity());
  std::vector<int> counts(part.bodies.size(), 0);
  for (const Instance& instance : part.instances) {
    if (instance.body == kNone) continue;
    if (++counts[instance.body] == 1)
      poses[instance.body].affine() =
          Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(instance.pose.data());
    else
      poses[instance.body].setIdentity();
  }
  return poses;
}

void addTriangles(const Part& part, std::uint32_t index, const Eigen::Affine3d& pose, Chains& chains) {
  const Body& body = part.bodies[index];
  for (std::uint32_t t = body.first_triangle; t < body.first_triangle + body.triangle_count; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& triangle = part.triangles[t];
      if (triangle.across[k] != kNone) continue;
      const std::uint32_t from = triangle.corner[k], to = triangle.corner[(k + 1) % 3];
      Eigen::AlignedBox3d box(pose * vec(part.points[from]));
      chains.add(from, to, index, box.extend(pose * vec(part.points[to])));
    }
}

Eigen::AlignedBox3d boxOf(const Geometry& geometry, const Edge& edge, const Eigen::Affine3d& pose) {
  constexpr int kPieces = 8;
  Eigen::AlignedBox3d box;
  spline::CurvePoint at;
  for (int i = 0; i <= kPieces; ++i) {
    geometry.curve(edge.curve, edge.t0 + (edge.t1 - edge.t0) * i / kPieces, at);
    box.extend(pose * at.C);
  }
  return box;
}

void addEdges(const Part& part, const Geometry& geometry, const std::vector<int>& uses, std::uint32_t index,
              const Eigen::Affine3d& pose, Chains& chains) {
  const Body& body = part.bodies[index];
  for (std::uint32_t e = body.first_edge; e < body.first_edge + body.edge_count; ++e) {
    const Edge& edge = part.edges[e];
    if (uses[e] == 1 && edge.curve != kNone)
      chains.add(edge.first_vertex, edge.last_vertex, index, boxOf(geometry, edge, pose));
  }
}

/// Returns the middle and the width of a box, in m if a coordinate is 1 m or more.
std::string placeOf(const Eigen::AlignedBox3d& box) {
  const double width = box.diagonal().norm();
  const bool large = std::max(width, box.center().cwiseAbs().maxCoeff()) >= 1;
  const double unit = large ? 1 : 1000;
  const auto rounded = [unit](double length) { return std::round(unit * length * 1e6) * 1e-6 + 0.0; };
  char text[120];
  std::snprintf(text, sizeof text, "around (%.4g, %.4g, %.4g) %s, %.3g %s wide", rounded(box.center().x()),
                rounded(box.center().y()), rounded(box.center().z()), large ? "m" : "mm", unit * width,
                large ? "m" : "mm");
  return text;
}

}  // namespace

std::vector<OpenBorder> openBorders(const Part& part) {
  std::vector<int> uses(part.edges.size(), 0);
  for (const Coedge& coedge : part.coedges) ++uses[coedge.edge];
  Chains of_points(part.points.size()), of_vertices(part.vertices.size());
  std::optional<Geometry> geometry;
  if (std::find(uses.begin(), uses.end(), 1) != uses.end()) geometry.emplace(part, spline::Form::kNet);
  const std::vector<Eigen::Affine3d> poses = onlyPoses(part);
  for (std::uint32_t b = 0; b < part.bodies.size(); ++b) {
    addTriangles(part, b, poses[b], of_points);
    if (geometry) addEdges(part, *geometry, uses, b, poses[b], of_vertices);
  }
  std::vector<OpenBorder> all = of_points.borders(), more = of_vertices.borders();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::string placesOf(const std::vector<OpenBorder>& borders) {
  constexpr std::size_t kMost = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(borders.size(), kMost); ++i)
    text += (i == 0 ? "" : "; ") + placeOf(borders[i].box);
  if (borders.size() > kMost) text += "; and " + std::to_string(borders.size() - kMost) + " smaller";
  return text;
}

}  // namespace hapticd::brep
