// SPDX-License-Identifier: MIT
/// Makes a part from a triangle mesh: repairs what can be repaired, and reports the repairs.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "kernels/brep/model/open_borders.hpp"
#include "kernels/part/part.hpp"
#include "mesh_import/mesh_crossings.hpp"
#include "mesh_import/mesh_file.hpp"

namespace hapticd::importing {

struct MeshOptions {
  double scale = 1;         ///< metres per unit of the file
  double smooth_angle = 0;  ///< [rad] normals are interpolated over edges that bend by less than this
  std::string unit{"m"};    ///< the unit that was assumed for the file's numbers; it is written into the part
  std::string placed{};     ///< how the points were turned and centred, such as "turned, z is up"; written as well
  /// is told which step of the work begins, such as "joining corners"
  std::function<void(const char* what)> progress = [](const char*) {};
};

/// A body of a mesh with several.
struct MeshBody {
  std::string name;
  std::size_t triangles = 0;
  bool closed = false;
};

/// Properties of a mesh, and the repairs that were made.
struct MeshReport {
  std::size_t triangles = 0, points = 0;  ///< numbers of triangles and points that were kept
  std::size_t joined = 0;                 ///< points that were joined with one that differs by rounding only
  std::size_t slivers = 0;                ///< triangles without width that were taken into a neighbour
  std::size_t solids_inside = 0;          ///< closed shells inside another one that face outward like it
  std::size_t degenerate = 0;             ///< triangles that were left out because they have no area
  std::size_t duplicates = 0;    ///< triangles that were left out because they have the same three corners as another
  std::size_t back_to_back = 0;  ///< triangles that were left out in pairs that lay back to back on one another
  std::size_t flipped = 0;       ///< triangles that were reversed to agree with others, or to make the volume positive
  std::size_t touching = 0;      ///< edges with more than two triangles, between which inside and outside alternate
  std::size_t non_manifold = 0;  ///< other edges with more than two triangles
  std::size_t unorientable = 0;  ///< edges whose two triangles cannot be given the same outward side
  std::size_t free_edges = 0, holes = 0;  ///< edges with only one triangle, and the closed chains that they form
  std::size_t shells = 0;                 ///< connected surfaces
  std::size_t coloured = 0;               ///< triangles with a colour
  bool closed = false;                    ///< true if the mesh bounds a volume
  double volume = 0;                      ///< [m^3] enclosed volume if closed
  Eigen::Vector3d size{0, 0, 0};          ///< [m] size of the bounding box
  std::vector<brep::OpenBorder> borders;  ///< where the holes are
  std::vector<MeshBody> bodies;           ///< if there are several
  Crossings crossings;                    ///< shells of one body that pass through each other
  Crossings overlaps;                     ///< bodies that pass through each other
  std::vector<std::string> remarks;       ///< what the reader of the file found odd

  /// Adds the report of one body.
  void add(const MeshReport& body);
};

/// [main] Makes a part with one body for each object of the file, and writes `file_name` into it as its source. @throws
/// std::invalid_argument if no triangle can be kept.
brep::Part meshPart(const MeshFile& mesh, const MeshOptions& options, const std::string& file_name, MeshReport& report);

/// [main] Returns the report as lines for a person. Counts that are zero are left out.
std::vector<std::string> linesOf(const MeshReport& report);

}  // namespace hapticd::importing
