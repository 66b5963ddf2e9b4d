// SPDX-License-Identifier: MIT
#include "drawing/coarse_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "drawing/clusters.hpp"
#include "drawing/triangle_distance.hpp"

namespace hapticd::drawing {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;
/// Normals of a cluster that differ by less than 36 degrees become one. Others stay apart: between them is an edge.
constexpr float kSmooth = 0.8f;

/// How far a place is from the planes of the triangles about a cluster, squared. (Quadrics: Garland and Heckbert,
/// Surface simplification using quadric error metrics, 1997.)
struct Quadric {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero(), sum = Eigen::Vector3d::Zero();
  double c = 0, weight = 0, count = 0;

  void addPlane(const Eigen::Vector3d& normal, const Eigen::Vector3d& at, double area) {
    const double d = -normal.dot(at);
    A += area * normal * normal.transpose();
    b += area * d * normal;
    c += area * d * d;
    weight += area;
  }
  /// Where the surface is flat, every place has the same distance 0: there the place nearest to the middle is best.
  double cost(const Eigen::Vector3d& p) const {
    constexpr double kMiddle = 1e-5;
    return p.dot(A * p) + 2 * b.dot(p) + c + kMiddle * weight * (p - sum / count).squaredNorm();
  }
};

/// Returns the place that draws each cluster: one of its own, at an edge or corner if it has any.
std::vector<std::uint32_t> representatives(const WeldedMesh& mesh, const Clusters& clusters) {
  const Eigen::Vector3d middle = 0.5 * (mesh.low + mesh.high);  // small numbers lose fewer digits
  const auto placed = [&](std::size_t i) { return Eigen::Vector3d(mesh.places[i].cast<double>() - middle); };
  std::vector<Quadric> quadrics(clusters.count);
  for (std::size_t t = 0; t < mesh.triangles(); ++t) {
    const Eigen::Vector3d vector = mesh.areaVector(t);
    const double area = vector.norm();
    if (!(area > 0)) continue;
    for (std::size_t k = 0; k < 3; ++k)
      quadrics[clusters.of[mesh.corners[3 * t + k]]].addPlane(vector / area, placed(mesh.corners[3 * t]), area);
  }
  for (std::size_t i = 0; i < mesh.places.size(); ++i) {
    Quadric& quadric = quadrics[clusters.of[i]];
    quadric.sum += placed(i);
    ++quadric.count;
  }
  std::vector<std::uint32_t> best(clusters.count, kNone);
  std::vector<double> least(clusters.count, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < mesh.places.size(); ++i) {
    const std::uint32_t cluster = clusters.of[i];
    const double cost = quadrics[cluster].cost(placed(i));
    if (best[cluster] != kNone && !(cost < least[cluster])) continue;
    best[cluster] = static_cast<std::uint32_t>(i);
    least[cluster] = cost;
  }
  return best;
}

/// True if colours are so near that one stands for the other: a scan has another colour at each point.
bool isAlike(std::uint32_t a, std::uint32_t b) {
  constexpr int kNear = 8;  // of 255
  if (a == b || a == 0 || b == 0) return a == b;
  for (int shift = 0; shift < 24; shift += 8)
    if (std::abs(static_cast<int>(a >> shift & 0xff) - static_cast<int>(b >> shift & 0xff)) > kNear) return false;
  return true;
}

/// Builds the lists of a drawing. A cluster has a vertex for each direction in which its surface looks, and each
/// colour.
class Builder {
 public:
  Builder(const hsp_mesh& mesh, const WeldedMesh& welded, const Clusters& clusters)
      : mesh_(mesh),
        welded_(welded),
        clusters_(clusters),
        places_(representatives(welded, clusters)),
        first_(clusters.count, kNone) {}

  CoarseMesh run() {
    const std::size_t corners = welded_.corners.size();
    side_of_.reserve(corners);
    for (std::size_t i = 0; i < corners; ++i) side_of_.push_back(sideOf(i));
    for (const std::uint32_t t : clusters_.triangles) {
      std::array<std::uint32_t, 3> at{};
      for (std::size_t k = 0; k < 3; ++k) at[k] = vertexOf(3 * std::size_t{t} + k);
      add(at, t);
    }
    for (const std::uint32_t t : clusters_.lone) {
      std::array<std::uint32_t, 3> at{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t corner = 3 * std::size_t{t} + k;
        at[k] = addVertex(welded_.places[welded_.corners[corner]], normalAt(corner), colourAt(corner));
      }
      add(at, t);
    }
    out_.off = largestDistance();
    return std::move(out_);
  }

 private:
  /// A cluster with more colours than this, which is noise, takes one for another: the list of its sides stays short.
  static constexpr std::uint32_t kMostColours = 16;

  /// The corners of a cluster that have nearly one colour and nearly the same normal.
  struct Side {
    std::uint32_t cluster, next;  ///< next: another side of the cluster, or kNone
    std::uint32_t colour;
    Eigen::Vector3f first, sum;    ///< normal of the first corner, sum of all normals
    std::uint32_t vertex = kNone;  ///< vertex of the drawing
  };

  bool hasNormals() const { return mesh_.normals != nullptr; }
  Eigen::Vector3f normalAt(std::size_t corner) const {
    if (!hasNormals()) return Eigen::Vector3f::Zero();
    return Eigen::Map<const Eigen::Vector3f>(mesh_.normals + 3 * std::size_t{mesh_.indices[corner]});
  }

  std::uint32_t colourAt(std::size_t corner) const {
    return mesh_.colours != nullptr ? mesh_.colours[mesh_.indices[corner]] : 0;
  }

  std::uint32_t sideOf(std::size_t corner) {
    const std::uint32_t cluster = clusters_.of[welded_.corners[corner]], colour = colourAt(corner);
    const Eigen::Vector3f normal = normalAt(corner);
    std::uint32_t seen = 0;
    for (std::uint32_t s = first_[cluster]; s != kNone; s = sides_[s].next)
      if ((isAlike(sides_[s].colour, colour) || ++seen > kMostColours) &&
          (!hasNormals() || sides_[s].first.dot(normal) >= kSmooth)) {
        sides_[s].sum += normal;
        return s;
      }
    sides_.push_back({cluster, first_[cluster], colour, normal, normal});
    return first_[cluster] = static_cast<std::uint32_t>(sides_.size() - 1);
  }

  std::uint32_t vertexOf(std::size_t corner) {
    Side& side = sides_[side_of_[corner]];
    if (side.vertex == kNone) side.vertex = addVertex(welded_.places[places_[side.cluster]], side.sum, side.colour);
    return side.vertex;
  }

  std::uint32_t addVertex(const Eigen::Vector3f& place, const Eigen::Vector3f& normal, std::uint32_t colour) {
    if (mesh_.colours != nullptr) out_.colours.push_back(colour);
    out_.xyz.insert(out_.xyz.end(), place.begin(), place.end());
    const Eigen::Vector3f unit = normal.normalized();
    if (hasNormals()) out_.normals.insert(out_.normals.end(), unit.begin(), unit.end());
    return static_cast<std::uint32_t>(out_.xyz.size() / 3 - 1);
  }

  Eigen::Vector3d placeOf(std::uint32_t vertex) const {
    return Eigen::Map<const Eigen::Vector3f>(out_.xyz.data() + 3 * std::size_t{vertex}).cast<double>();
  }

  /// Adds a triangle. One that was turned over becomes counter-clockwise again, as its normals say.
  /// @param from the triangle of the plugin that it draws
  void add(std::array<std::uint32_t, 3> at, std::size_t from) {
    const std::uint32_t* places = welded_.corners.data() + 3 * from;
    drawn_.push_back({clusters_.of[places[0]], clusters_.of[places[1]], clusters_.of[places[2]]});
    if (hasNormals()) {
      const Eigen::Vector3d a = placeOf(at[0]), up = (placeOf(at[1]) - a).cross(placeOf(at[2]) - a);
      Eigen::Vector3d wanted = Eigen::Vector3d::Zero();
      for (const std::uint32_t v : at)
        wanted += Eigen::Map<const Eigen::Vector3f>(out_.normals.data() + 3 * std::size_t{v}).cast<double>();
      if (up.dot(wanted) < 0) std::swap(at[1], at[2]);
    }
    out_.indices.insert(out_.indices.end(), at.begin(), at.end());
  }

  /// Returns, for each cluster, the triangles of the drawing that have a corner in it.
  std::vector<std::vector<std::uint32_t>> trianglesOfClusters() const {
    std::vector<std::vector<std::uint32_t>> lists(clusters_.count);
    for (std::uint32_t t = 0; t < drawn_.size(); ++t)
      for (const std::uint32_t cluster : drawn_[t]) lists[cluster].push_back(t);
    return lists;
  }

  double distanceTo(std::uint32_t triangle, const Eigen::Vector3d& p) const {
    const std::uint32_t* at = out_.indices.data() + 3 * std::size_t{triangle};
    return distance(p, placeOf(at[0]), placeOf(at[1]), placeOf(at[2]));
  }

  /// Returns the largest distance of a place from the triangles about its cluster and about the neighbours of that. No
  /// place is farther away from the drawing.
  double largestDistance() const {
    const auto lists = trianglesOfClusters();
    double largest = 0;
    for (std::size_t i = 0; i < welded_.places.size(); ++i) {
      const std::vector<std::uint32_t>& own = lists[clusters_.of[i]];
      const Eigen::Vector3d p = welded_.places[i].cast<double>();
      double nearest = std::numeric_limits<double>::infinity();
      const auto look = [&](const std::vector<std::uint32_t>& list) {
        for (std::size_t k = 0; k < list.size() && nearest > largest; ++k)  // a nearer place does not change the result
          nearest = std::min(nearest, distanceTo(list[k], p));
      };
      look(own);
      for (std::size_t k = 0; k < own.size() && nearest > largest; ++k)
        for (const std::uint32_t neighbour : drawn_[own[k]]) look(lists[neighbour]);
      largest = std::max(largest, nearest);
    }
    return largest;
  }

  const hsp_mesh& mesh_;
  const WeldedMesh& welded_;
  const Clusters& clusters_;
  std::vector<std::uint32_t> places_;   ///< place that draws each cluster
  std::vector<std::uint32_t> first_;    ///< a side of each cluster, or kNone
  std::vector<std::uint32_t> side_of_;  ///< side of each corner
  std::vector<Side> sides_;
  std::vector<std::array<std::uint32_t, 3>> drawn_;  ///< clusters of each triangle of the drawing
  CoarseMesh out_;
};

}  // namespace

hsp_mesh CoarseMesh::view() const {
  hsp_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = static_cast<std::uint32_t>(xyz.size() / 3);
  mesh.triangle_count = static_cast<std::uint32_t>(indices.size() / 3);
  mesh.xyz = xyz.data();
  mesh.normals = normals.empty() ? nullptr : normals.data();
  mesh.indices = indices.data();
  mesh.colours = colours.empty() ? nullptr : colours.data();
  return mesh;
}

CoarseMesh MeshReducer::reduce(std::size_t most) const {
  const Clusters clusters = finestClusters(welded_, most);
  return Builder(mesh_, welded_, clusters).run();
}

}  // namespace hapticd::drawing
