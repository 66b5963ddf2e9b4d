// SPDX-License-Identifier: MIT
/// Finds where shells of a mesh pass through each other. Such a mesh does not bound a solid, even if each edge belongs
/// to two triangles.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hapticd::importing {

struct Crossings {
  std::size_t pairs = 0;           ///< number of pairs of triangles from two shells that intersect
  Eigen::Vector3d first{0, 0, 0};  ///< [m] place of the first intersection
  bool all_tried = true;           ///< false if there were too many pairs to try all of them
};

/// [main] Counts crossings. Triangles that only touch do not count. @param shell number of the shell of each triangle
Crossings crossingsOf(const std::vector<Eigen::Vector3d>& points,
                      const std::vector<std::array<std::uint32_t, 3>>& corners, const std::vector<std::uint32_t>& shell,
                      std::size_t shells);

}  // namespace hapticd::importing
