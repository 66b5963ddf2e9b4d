// SPDX-License-Identifier: MIT
/// Triangles whose corners at the same place are joined. A plugin may give each triangle corners of its own.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hapticd/shape.h"

namespace hapticd::drawing {

struct WeldedMesh {
  std::vector<Eigen::Vector3f> places;  ///< [m] in the frame of the mesh; each is a corner of a triangle
  std::vector<Eigen::Vector3f> up;      ///< of each place, the sum of the area vectors [m^2] of its triangles
  std::vector<std::uint32_t> corners;   ///< places of the corners: 3 per triangle, in the order of the mesh
  Eigen::Vector3d low, high;            ///< [m] box of the places
  double area = 0;                      ///< [m^2] of all triangles

  std::size_t triangles() const { return corners.size() / 3; }
  Eigen::Vector3d place(std::size_t triangle, std::size_t corner) const {
    return places[corners[3 * triangle + corner]].cast<double>();
  }
  /// Half the cross product of two sides: it points outward and is as long as the triangle is large [m^2].
  Eigen::Vector3d areaVector(std::size_t triangle) const;
};

/// [main] Joins corners whose coordinates are equal. The mesh must be one that host::ShapeInstance has checked.
WeldedMesh weld(const hsp_mesh& mesh);

}  // namespace hapticd::drawing
