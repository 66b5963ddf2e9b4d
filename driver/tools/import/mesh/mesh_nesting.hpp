// SPDX-License-Identifier: MIT
/// Which closed shells of a mesh are inside out.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace hapticd::importing {

/// What is known of the shells of a mesh.
struct Shells {
  const std::vector<Eigen::Vector3d>& points;
  const std::vector<std::array<std::uint32_t, 3>>& corners;
  const std::vector<std::uint32_t>& shell;  ///< shell of each triangle
  const std::vector<char>& closed;          ///< one for each shell
};

/// What was found out about them.
struct Nesting {
  std::vector<double> volume;     ///< [m^3] enclosed volume of each shell; negative if it faces inward
  std::vector<char> inside_out;   ///< 1 for each shell that has to be turned
  bool incomplete = false;        ///< there were too many shells to look for cavities in all of them
  std::size_t solids_inside = 0;  ///< shells that lie inside another one and, after turning, face outward like it
};

/// [main] A shell that lies in no other one must enclose a positive volume. A shell inside another one may be a cavity,
/// so it is turned only together with the shell around it: then the whole file was inside out.
Nesting nestingOf(const Shells& shells);

}  // namespace hapticd::importing
