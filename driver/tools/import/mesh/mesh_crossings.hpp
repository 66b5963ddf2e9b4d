// SPDX-License-Identifier: MIT
/// Where shells of a mesh pass through each other: such a mesh bounds no solid, whatever its edges say.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hapticd::importing {

struct Crossings {
  std::size_t pairs = 0;           ///< triangles of two shells that intersect
  Eigen::Vector3d first{0, 0, 0};  ///< [m] place of the first intersection
  bool all_tried = true;           ///< false: there were too many to try all of them
};

/// [main] Faces that only touch do not cross. @param shell of each triangle
Crossings crossingsOf(const std::vector<Eigen::Vector3d>& points,
                      const std::vector<std::array<std::uint32_t, 3>>& corners, const std::vector<std::uint32_t>& shell,
                      std::size_t shells);

}  // namespace hapticd::importing
