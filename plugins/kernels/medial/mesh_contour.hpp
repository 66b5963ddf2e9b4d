// SPDX-License-Identifier: MIT
/// The surface of a medial mesh as triangles: closed, whatever branches it has, with every vertex on a cone or slab.
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
  /// [main] Triangles within about `chord_error` [m] of the body at rest, but for creases, which they round; made by
  /// marching tetrahedra over the cells of a cube that the surface crosses. Where that would take more than 256 cells
  /// a side, or the cells would be finer than 1/1000 of the body, the error is larger.
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
  double cell_ = 0;                                   ///< [m] side of a cell
  uint32_t start_ = MedialMesh::kNoStart;             ///< where the last search ended
  std::unordered_map<uint64_t, double> distances_;    ///< at corners; only while building
  std::unordered_map<uint64_t, uint32_t> crossings_;  ///< vertices on edges of tetrahedra, by the middle of the edge
};

}  // namespace hapticd::medial
