// SPDX-License-Identifier: MIT
/// A part that is ready for search: a tree of boxes over the elements of each body, normals of corners, and the bodies
/// in their places.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "kernels/brep/elements/elements.hpp"
#include "kernels/brep/elements/recognised_edges.hpp"
#include "kernels/brep/tree/box_tree.hpp"
#include "kernels/brep/tree/row_box.hpp"
#include "kernels/brep/tree/row_disc.hpp"

namespace hapticd::brep {

struct ModelOptions {
  spline::Form form = spline::Form::kTable;  ///< how spline surfaces and edges are stored
  /// Name of one instance or assembly, or its path "assembly/sub/part"; empty for the whole part. The instance keeps
  /// the pose that it has in the part.
  std::string instance;
  /// Names or paths of instances or assemblies that are left out.
  std::vector<std::string> without;
  /// Keep the empty balls of a mesh, so that a probe can be followed over it quickly. They are found if the part does
  /// not have them and the mesh is not large, because that takes some microseconds a triangle.
  bool empty_balls = true;
};

/// A body at its pose in the model.
struct Placement {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< from the body's frame to the model's
  Eigen::Vector3d position{0, 0, 0};
  std::uint32_t body = 0;
  std::uint32_t instance = 0;       ///< index in the part's instances
  std::uint32_t first_feature = 0;  ///< feature number of the body's first face or triangle
  bool moved = false;               ///< true if the pose is not the identity
  bool solid = false;               ///< true if the body bounds a volume, so that it has an inside

  Eigen::Vector3d toBody(const Eigen::Vector3d& p) const noexcept {
    return moved ? Eigen::Vector3d(rotation.transpose() * (p - position)) : p;
  }
};

/// The normal at a vertex, or at a point of a mesh.
struct CornerNormal {
  Eigen::Vector3f normal{0, 0, 0};  ///< angle-weighted mean of the outward normals (Baerentzen & Aanaes 2005), unit
  bool open = false;                ///< true if a free edge ends there
  bool narrow = false;              ///< true if a triangle is there that isNarrow(), far away
};

/// The elements of one body.
struct BodyTree {
  static constexpr std::int32_t kNoRoot = -1;  ///< root of a face without elements
  /// Triangles in one row. One disc around two triangles is used, because the distance to a disc costs less than that
  /// to a triangle.
  static constexpr int kMeshRow = 2;

  /// Elements in one row of a body of which most elements are leaves and pieces. Each of them has a close box of its
  /// own. Of other bodies a row has one element: they have so few elements that small trees matter less than quick
  /// ones.
  static constexpr int kElementRow = 4;
  static constexpr int kFaceRow = 8;  ///< elements in one row of the tree of a single face

  BoxTree tree;
  std::vector<Element> elements;  ///< elements in the order of the tree
  std::vector<RowBox> rows;       ///< box of each element, in the order of the tree; empty for meshes
  std::vector<RowDisc> discs;     ///< disc of each row, indexed by row number; empty except for meshes
  /// The elements of the trees of single faces, as places in `elements`. The rows of these trees are ranges of it.
  std::vector<std::uint32_t> of_faces;

  /// [rt] Prefetches a child of a node that will be examined soon. @param row number of the row, for a child that is a
  /// row
  void fetchAhead(std::int32_t child, std::int32_t row) const noexcept {
    if (child >= 0) {
      __builtin_prefetch(&tree.node(child).lo);
      __builtin_prefetch(&tree.node(child).child);
    } else if (!discs.empty()) {
      __builtin_prefetch(&discs[static_cast<std::size_t>(row)]);
    } else {
      const ElementRow elements_of = BoxTree::rowOf(child);
      for (std::uint32_t i = 0; i < elements_of.count; ++i) __builtin_prefetch(&rows[elements_of.first + i]);
    }
  }

  template <class Shape>
  const std::vector<Shape>& shapes() const noexcept {
    if constexpr (std::is_same_v<Shape, RowDisc>)
      return discs;
    else
      return rows;
  }
};

/// A part ready for search. It is built once and is then constant, so every const function may run in any thread.
class Model {
 public:
  /// [main] @throws std::invalid_argument with a text for the user, if `options.instance` is not a name in the part or
  /// the part has no faces.
  explicit Model(Part part, const ModelOptions& options = {});
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  /// [any] The part without the numbers of the splines of surfaces and edges: their `count` is 0. So no second model
  /// can be made from it.
  const Part& part() const noexcept { return part_; }
  const Geometry& geometry() const noexcept { return *geometry_; }
  const FaceShape& face(std::uint32_t index) const noexcept { return faces_[index]; }
  /// [any] The edge must be a line or a circle, in the file or recognised.
  const EdgeShape& edge(std::uint32_t index) const noexcept { return edges_[edge_slots_[index]]; }
  /// [any] @param index EdgeShape::recognised, which must not be kNone
  const RecognisedEdge& recognised(std::uint32_t index) const noexcept { return recognised_[index]; }
  const Leaf& leaf(std::uint32_t index) const noexcept { return leaves_[index]; }
  const CurvePiece& piece(std::uint32_t index) const noexcept { return pieces_[index]; }
  /// [any] Returns the edge (index in the part) of which an element is all or a piece, or kNone if it is not of an
  /// edge.
  std::uint32_t edgeOf(Element element) const noexcept {
    const ElementKind kind = element.kind();
    if (kind == ElementKind::kPiece) return pieces_[element.index()].edge;
    const bool is_edge = kind == ElementKind::kLine || kind == ElementKind::kCircle || kind == ElementKind::kPole;
    return is_edge ? element.index() : kNone;
  }
  std::size_t leafCount() const noexcept { return leaves_.size(); }
  std::size_t pieceCount() const noexcept { return pieces_.size(); }
  const CornerNormal& vertexNormal(std::uint32_t vertex) const noexcept { return vertex_normals_[vertex]; }
  const CornerNormal& pointNormal(std::uint32_t point) const noexcept { return point_normals_[point]; }
  bool hasNarrow() const noexcept { return has_narrow_; }  ///< [any] true if a CornerNormal of a point is narrow
  /// [any] Returns the edges that end at a vertex.
  std::span<const std::uint32_t> edgesAt(std::uint32_t vertex) const noexcept {
    const std::uint32_t first = first_edge_at_[vertex];
    return std::span(edges_at_).subspan(first, first_edge_at_[vertex + 1] - first);
  }
  /// [any] Returns the normal at a corner that is interpolated over a triangle, or null if normals are not interpolated
  /// there.
  const Eigen::Vector3f* smoothNormal(std::uint32_t triangle, int corner) const noexcept {
    if (smooth_corner_.empty()) return nullptr;
    const std::uint32_t at = smooth_corner_[3 * std::size_t{triangle} + static_cast<std::size_t>(corner)];
    return at == kNone ? nullptr : &smooth_normals_[at];
  }

  /// [any] Returns the empty balls of each triangle, if the model is one mesh; else nothing.
  const std::vector<EmptyBalls>& emptyBalls() const noexcept { return part_.balls; }

  const std::vector<Placement>& placements() const noexcept { return placements_; }
  const BodyTree& body(std::uint32_t index) const noexcept { return bodies_[index]; }
  /// [any] Returns the root node of the tree over one face and its edges alone, inside the tree of its body. @param
  /// index face in the part
  std::int32_t rootOfFace(std::uint32_t index) const noexcept { return face_roots_[index]; }
  /// [any] Tree of the boxes of all placements in the model's frame; empty if there is only one placement.
  const BoxTree& placementTree() const noexcept { return placement_tree_; }
  /// [any] Number of faces and triangles over all instances of the part.
  std::uint32_t featureCount() const noexcept { return feature_count_; }
  /// [main] Names the instance and the face of a feature, such as "bolt: face 3 'head'".
  std::string featureName(std::uint32_t feature) const;

  const Eigen::AlignedBox3d& bounds() const noexcept { return bounds_; }
  /// [any] True if at least one body does not bound a volume.
  bool open() const noexcept { return open_; }
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }
  std::size_t bytes() const noexcept;

 private:
  friend class ModelBuilder;

  Part part_;
  std::unique_ptr<Geometry> geometry_;
  std::vector<FaceShape> faces_;
  std::vector<EdgeShape> edges_;           ///< only lines and circles
  std::vector<std::uint32_t> edge_slots_;  ///< for each edge of the part its index in edges_, or kNone
  std::vector<RecognisedEdge> recognised_;
  std::vector<Leaf> leaves_;
  std::vector<CurvePiece> pieces_;
  std::vector<CornerNormal> vertex_normals_, point_normals_;
  std::vector<std::uint32_t> first_edge_at_, edges_at_;  ///< edges at vertex i: edges_at_[first_edge_at_[i]] on
  std::vector<std::uint32_t> smooth_corner_;
  std::vector<Eigen::Vector3f> smooth_normals_;
  std::vector<BodyTree> bodies_;
  std::vector<std::int32_t> face_roots_;  ///< one per face, see rootOfFace()
  std::vector<Placement> placements_;
  BoxTree placement_tree_;
  Eigen::AlignedBox3d bounds_;
  std::vector<std::string> warnings_;
  std::uint32_t feature_count_ = 0;
  bool open_ = false, has_narrow_ = false;
};

}  // namespace hapticd::brep
