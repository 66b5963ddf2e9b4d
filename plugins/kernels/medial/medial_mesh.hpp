// SPDX-License-Identifier: MIT
/// A medial mesh: spheres joined by edges and triangles, in any order and with any branches. The body is the union of
/// the cones and slabs that they span, with its distance in closed form (primitives.hpp) behind a tree of boxes.
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

/// A medial mesh as files have it; indices count from 0.
struct MeshData {
  std::vector<Sphere> vertices;
  std::vector<std::array<int, 2>> edges;
  std::vector<std::array<int, 3>> triangles;
};

/// A foot, and the cone or slab that has it.
struct MeshFoot : HullFoot {
  uint32_t element = 0;
};

/// The nearest feet and those nearly as near, nearest first.
struct MeshFeet {
  static constexpr std::size_t kMost = 8;
  std::array<MeshFoot, kMost> feet;
  std::size_t count = 0;
  int evaluations = 0;  ///< primitives that were examined
  int visits = 0;       ///< nodes of the tree that were examined, including leaves
  double doubt = 0;     ///< [m] by which another primitive may be nearer; 0: none is
};

class MedialMesh {
 public:
  /// One sphere, a cone of two or a slab of three vertices; unused ones repeat the first.
  struct Element {
    std::array<uint32_t, 3> vertex{};
    uint8_t count = 0;
  };
  static constexpr uint32_t kNoStart = UINT32_MAX;
  static constexpr int kMostVisits = 6000;  ///< of a search in a tick: half of a 1 kHz tick, where all are as near

  /// [main] Edges of triangles are part of their slabs, and vertices of edges part of their cones.
  /// @throws std::invalid_argument for no vertices, indices out of range or repeated, numbers that are not finite.
  explicit MedialMesh(const MeshData& data);

  /// [any] The feet of p within `band` [m] of the nearest one. `start`: an element that was nearest a moment ago.
  /// `most_visits`: nodes after which the search ends with its result so far and a doubt, as it may in the middle of a
  /// body whose parts are all equally near.
  void nearest(const Eigen::Vector3d& p, uint32_t start, double band, MeshFeet& out,
               int most_visits = INT_MAX) const noexcept;
  /// [any] The foot of p on one cone or slab.
  HullFoot footOn(uint32_t element, const Eigen::Vector3d& p) const noexcept;
  /// [any] Signed distance of p to the body: negative inside.
  double distance(const Eigen::Vector3d& p) const noexcept;

  const std::vector<Sphere>& vertices() const noexcept { return vertices_; }
  const std::vector<Element>& elements() const noexcept { return elements_; }
  /// [any] Unit normal of a slab; zero for what has no plane.
  Eigen::Vector3d across(uint32_t element) const noexcept;
  /// [any] Weights of an element's vertices at a foot on it.
  std::array<double, 3> weights(uint32_t element, const Eigen::Array2d& parameter) const noexcept;
  const Eigen::AlignedBox3d& bounds() const noexcept { return bounds_; }  ///< of all spheres
  double leastRadius() const noexcept { return least_radius_; }           ///< [m] a length that is not zero
  std::size_t bytes() const noexcept;

 private:
  /// The centres of some elements lie in a box, and no radius among them is greater than `radius`.
  struct alignas(64) Node {
    Eigen::Vector3d low, high;
    double radius = 0;
    uint32_t child = 0;  ///< the first of two; a leaf: its element
    bool leaf = false;
  };

  static double lowerBound(const Node& node, const Eigen::Vector3d& p) noexcept;
  void gather(const MeshData& data);
  void buildTree();
  static Node boundsOf(const std::vector<Node>& boxes, std::span<const uint32_t> members);
  /// Sorts the members' lower half along their longest extent to the front. @return how many there are
  static std::size_t halve(const std::vector<Node>& boxes, std::span<uint32_t> members);
  /// Takes the foot among the nearest if it lies within `band` of the nearest one.
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
