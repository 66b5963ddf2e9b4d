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
  std::size_t pairs = 0;           ///< triangles of two shells that cut each other
  Eigen::Vector3d first{0, 0, 0};  ///< [m] where the first of them do
  bool all_tried = true;           ///< false: there were too many to try them all
};

/// [main] Faces that only touch do not cross. @param shell of each triangle
Crossings crossingsOf(const std::vector<Eigen::Vector3d>& points,
                      const std::vector<std::array<std::uint32_t, 3>>& corners, const std::vector<std::uint32_t>& shell,
                      std::size_t shells);

}  // namespace hapticd::importing
