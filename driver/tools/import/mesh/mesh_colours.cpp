// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_colours.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;

/// Returns which corner of a triangle of the file is nearest to a point [m].
std::size_t nearestCorner(const MeshFile& file, double scale, std::uint32_t triangle, const Vector3d& point) {
  const auto off = [&](std::size_t k) {
    return (scale * file.points[file.corners[triangle][k]] - point).squaredNorm();
  };
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (off(k) < off(nearest)) nearest = k;
  return nearest;
}

}  // namespace

std::uint32_t colourWord(double red, double green, double blue) {
  if (std::isnan(red) || std::isnan(green) || std::isnan(blue)) return 0;
  const auto byte = [](double share) {
    return static_cast<std::uint32_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
  };
  constexpr std::uint32_t kOpaque = 0xff000000u;
  return byte(red) | byte(green) << 8 | byte(blue) << 16 | kOpaque;
}

std::size_t addColours(const MeshFile& file, double scale, const RepairedMesh& mesh, brep::Part& part) {
  if (file.colours.empty()) return 0;
  part.colours.resize(part.triangles.size() - mesh.corners.size());  // bodies before this one may have none
  std::size_t coloured = 0;
  for (std::size_t t = 0; t < mesh.corners.size(); ++t) {
    brep::CornerColours colours;
    for (std::size_t k = 0; k < 3; ++k)
      colours.corner[k] =
          file.colours[mesh.from[t]][nearestCorner(file, scale, mesh.from[t], mesh.points[mesh.corners[t][k]])];
    coloured += colours.corner == std::array<std::uint32_t, 3>{} ? 0 : 1;
    part.colours.push_back(colours);
  }
  return coloured;
}

}  // namespace hapticd::importing
