// SPDX-License-Identifier: MIT
#include "import/triangles.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <map>

namespace hapticd::importing {

Result<void> orientClosed(Triangles& mesh, const std::string& file) {
  std::map<std::array<uint32_t, 2>, int> directed;
  for (const auto& c : mesh.corners)
    for (std::size_t k = 0; k < 3; ++k) ++directed[{c[k], c[(k + 1) % 3]}];
  std::size_t open = 0;
  for (const auto& [edge, count] : directed) {
    const auto back = directed.find({edge[1], edge[0]});
    open += count != 1 || back == directed.end() || back->second != 1 ? 1 : 0;
  }
  if (open > 0)
    return Error{
        file + ": " + std::to_string(open) +
        " edges do not have exactly one triangle on each side, both turned the same way; expected a closed surface"};
  double volume = 0;
  for (const auto& c : mesh.corners) volume += mesh.points[c[0]].dot(mesh.points[c[1]].cross(mesh.points[c[2]])) / 6;
  if (!(std::fabs(volume) > 0))
    return Error{file + ": the surface encloses no volume; expected a closed surface that is not flat"};
  if (volume < 0)
    for (auto& c : mesh.corners) std::swap(c[1], c[2]);
  return {};
}

}  // namespace hapticd::importing
