// SPDX-License-Identifier: MIT
/// The surface of a medial mesh as triangles. It is closed even if the mesh has branches, and every vertex lies on a
/// cone or slab.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "kernels/medial/medial_mesh.hpp"
#include "kernels/medial/moving_mesh.hpp"

namespace hapticd::medial {

class MeshContour : public MovingMesh {
 public:
  /// [main] Makes triangles that are within about `chord_error` [m] of the body at rest, except at creases, which are
  /// rounded. The method is marching tetrahedra, over the cells of a cube through which the surface passes. The error
  /// is larger if it would need more than 256 cells per side, or cells smaller than 1/1000 of the body.
  MeshContour(const MedialMesh& mesh, double chord_error);

 private:
  using Cell = Eigen::Matrix<int, 3, 1>;

  void visit(const Cell& low, int size);
  void cut(const Cell& cell);
  void tetrahedron(const std::array<Cell, 4>& corners, const std::array<double, 4>& distances);
  double distanceAt(const Cell& corner);
  uint32_t vertexOn(const Cell& a, double at_a, const Cell& b, double at_b);
  Eigen::Vector3d place(const Cell& corner) const { return origin_ + cell_ * corner.cast<double>(); }

  const MedialMesh* mesh_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double cell_ = 0;                                 ///< [m] side of a cell
  uint32_t start_ = MedialMesh::kNoStart;           ///< where the last search ended
  std::unordered_map<uint64_t, double> distances_;  ///< [m] signed distances at corners; only while building
  /// vertices on the edges of tetrahedra; the key is the middle of the edge
  std::unordered_map<uint64_t, uint32_t> crossings_;
};

}  // namespace hapticd::medial
