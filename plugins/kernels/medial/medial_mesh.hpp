// SPDX-License-Identifier: MIT
/// A medial mesh: spheres joined by edges and triangles, in any order and with any branches. The body is the union of
/// the cones and slabs that the spheres span. Its distance is computed in closed form (primitives.hpp), and a tree of
/// boxes finds the nearest cone or slab.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <climits>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/medial/primitives.hpp"

namespace hapticd::medial {

constexpr double kLargestUsual = 1.5;  ///< [m] no arm reaches round a larger body, so its file may be in millimetres

/// A medial mesh as in a file; indices count from 0.
struct MeshData {
  std::vector<Sphere> vertices;
  std::vector<std::array<int, 2>> edges;
  std::vector<std::array<int, 3>> triangles;
};

/// A foot, and the cone or slab on which it lies.
struct MeshFoot : HullFoot {
  uint32_t element = 0;
};

/// The nearest foot, and others that are nearly as near, nearest first.
struct MeshFeet {
  static constexpr std::size_t kMost = 8;
  std::array<MeshFoot, kMost> feet;
  std::size_t count = 0;
  int evaluations = 0;  ///< primitives that were examined
  int visits = 0;       ///< nodes of the tree that were examined, including leaves
  /// [m] by how much another primitive may be nearer than the first foot, because the search ended early; 0 if none may
  double doubt = 0;
};

class MedialMesh {
 public:
  /// A sphere (one vertex), a cone (two) or a slab (three); unused entries repeat the first vertex.
  struct Element {
    std::array<uint32_t, 3> vertex{};
    uint8_t count = 0;
  };
  static constexpr uint32_t kNoStart = UINT32_MAX;
  /// limit for a search in one tick; in the worst case, when all parts are equally near, it takes half of a 1 kHz tick
  static constexpr int kMostVisits = 6000;

  /// [main] Builds the tree. Edges of triangles are part of their slabs and make no cones of their own; vertices of
  /// edges make no spheres of their own.
  /// @throws std::invalid_argument for no vertices, indices out of range or repeated, numbers that are not finite.
  explicit MedialMesh(const MeshData& data);

  /// [any] Finds the nearest foot of p, and others that are at most `band` [m] farther away.
  /// @param start element that is examined first, such as the nearest one of the last tick; or kNoStart
  /// @param most_visits number of nodes of the tree after which the search ends early. The result is then the best one
  /// so far, with a `doubt`. This may happen in the middle of a body whose parts are all equally near
  void nearest(const Eigen::Vector3d& p, uint32_t start, double band, MeshFeet& out,
               int most_visits = INT_MAX) const noexcept;
  /// [any] Returns the foot of p on one cone or slab.
  HullFoot footOn(uint32_t element, const Eigen::Vector3d& p) const noexcept;
  /// [any] Returns the signed distance [m] from p to the body: negative inside.
  double distance(const Eigen::Vector3d& p) const noexcept;

  const std::vector<Sphere>& vertices() const noexcept { return vertices_; }
  const std::vector<Element>& elements() const noexcept { return elements_; }
  /// [any] Returns the unit normal of a slab; zero for a cone, a sphere, or a slab without a plane.
  Eigen::Vector3d across(uint32_t element) const noexcept;
  /// [any] Returns the weights of an element's vertices at a foot on this element.
  std::array<double, 3> weights(uint32_t element, const Eigen::Array2d& parameter) const noexcept;
  const Eigen::AlignedBox3d& bounds() const noexcept { return bounds_; }  ///< box of all spheres
  /// [m] smallest radius that is not zero; 0 if all are 0
  double leastRadius() const noexcept { return least_radius_; }
  std::size_t bytes() const noexcept;

 private:
  /// A node of the tree: a box that holds the centres of some elements' spheres; none of these radii is greater than
  /// `radius`.
  struct alignas(64) Node {
    Eigen::Vector3d low, high;
    double radius = 0;
    uint32_t child = 0;  ///< inner node: index of the first of its two children; leaf: index of its element
    bool leaf = false;
  };

  static double lowerBound(const Node& node, const Eigen::Vector3d& p) noexcept;
  void gather(const MeshData& data);
  void buildTree();
  static Node boundsOf(const std::vector<Node>& boxes, std::span<const uint32_t> members);
  /// Sorts the half of the members that is lower along their longest extent to the front.
  /// @return the number of members in this half
  static std::size_t halve(const std::vector<Node>& boxes, std::span<uint32_t> members);
  /// Adds the foot to `out` if it is at most `band` [m] farther away than the nearest one.
  static void enter(const HullFoot& foot, uint32_t element, double band, MeshFeet& out) noexcept;
  Node boxOf(uint32_t element) const;

  std::vector<Sphere> vertices_;
  std::vector<Element> elements_;  ///< cones first, then slabs
  std::vector<Cone> cones_;
  std::vector<Slab> slabs_;
  std::vector<Node> nodes_;
  Eigen::AlignedBox3d bounds_;
  double least_radius_ = 0;
};

}  // namespace hapticd::medial
