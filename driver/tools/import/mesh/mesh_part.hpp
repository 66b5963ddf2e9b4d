// SPDX-License-Identifier: MIT
/// Makes a part of a triangle mesh: repairs what can be repaired, and reports it.
#pragma once
#include "kernels/brep/part.hpp"
#include "mesh_import/mesh_crossings.hpp"
#include "mesh_import/mesh_file.hpp"

namespace hapticd::importing {

struct MeshOptions {
  double scale = 1;         ///< metres per unit of the file
  double smooth_angle = 0;  ///< [rad] normals are interpolated over edges that bend by less than this
  std::string unit{"m"};    ///< the unit that was assumed for the file's numbers, as the part notes it
};

/// What was found in a mesh, and what was done about it.
struct MeshReport {
  std::size_t triangles = 0, points = 0;  ///< kept
  std::size_t degenerate = 0;             ///< left out: without area
  std::size_t duplicates = 0;             ///< left out, because they have the same three corners as another
  std::size_t flipped = 0;                ///< reversed, to agree with their neighbours or to enclose a volume
  std::size_t non_manifold = 0;           ///< edges of more than two triangles
  std::size_t unorientable = 0;           ///< edges whose triangles cannot agree about the outside
  std::size_t free_edges = 0, holes = 0;  ///< edges of one triangle, and the closed chains that they form
  std::size_t shells = 0;                 ///< connected surfaces
  bool closed = false;                    ///< it bounds a volume
  double volume = 0;                      ///< [m^3] if closed
  Eigen::Vector3d size{0, 0, 0};          ///< [m] of the box
  Crossings crossings;                    ///< shells that pass through each other
};

/// [main] One body of triangles, in which `file_name` is noted. @throws std::invalid_argument if nothing is left of it.
brep::Part meshPart(const MeshFile& mesh, const MeshOptions& options, const std::string& file_name, MeshReport& report);

/// [main] The report as lines for a person. Empty parts are left out.
std::vector<std::string> linesOf(const MeshReport& report);

}  // namespace hapticd::importing
