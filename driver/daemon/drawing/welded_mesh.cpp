// SPDX-License-Identifier: MIT
#include "drawing/welded_mesh.hpp"

#include <Eigen/Geometry>
#include <bit>
#include <limits>

#include "drawing/numbering.hpp"

namespace hapticd::drawing {

Eigen::Vector3d WeldedMesh::areaVector(std::size_t triangle) const {
  const Eigen::Vector3d a = place(triangle, 0);
  return 0.5 * (place(triangle, 1) - a).cross(place(triangle, 2) - a);
}

WeldedMesh weld(const hsp_mesh& mesh) {
  WeldedMesh welded;
  const std::size_t count = 3 * std::size_t{mesh.triangle_count};
  Numbering numbers(mesh.vertex_count);
  welded.low.setConstant(std::numeric_limits<double>::infinity());
  welded.high = -welded.low;
  welded.corners.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    // adding 0 turns -0 into 0, which is the same place
    const Eigen::Vector3f p =
        Eigen::Map<const Eigen::Vector3f>(mesh.xyz + 3 * std::size_t{mesh.indices[i]}).array() + 0.0f;
    const std::uint32_t number = numbers({std::bit_cast<std::uint32_t>(p.x()), std::bit_cast<std::uint32_t>(p.y()),
                                          std::bit_cast<std::uint32_t>(p.z())});
    if (number == welded.places.size()) {
      welded.places.push_back(p);
      welded.low = welded.low.cwiseMin(p.cast<double>());
      welded.high = welded.high.cwiseMax(p.cast<double>());
    }
    welded.corners.push_back(number);
  }
  welded.up.assign(welded.places.size(), Eigen::Vector3f::Zero());
  for (std::size_t t = 0; t < welded.triangles(); ++t) {
    const Eigen::Vector3d vector = welded.areaVector(t);
    welded.area += vector.norm();
    for (std::size_t k = 0; k < 3; ++k) welded.up[welded.corners[3 * t + k]] += vector.cast<float>();
  }
  return welded;
}

}  // namespace hapticd::drawing
