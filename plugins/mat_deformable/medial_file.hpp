// SPDX-License-Identifier: MIT
/// Model files of soft bodies: the grid or the mesh of a medial axis.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "kernels/medial/mesh_body.hpp"

namespace hapticd {

/// [m] greatest coordinate and greatest radius. The squares of larger numbers would lose all digits of small distances
inline constexpr double kFarthestPoint = 1e6;

/// The contents of a model file: a body from a grid or from a mesh.
struct MedialFile {
  std::optional<medial::BodyData> grid;
  std::optional<medial::MeshBodyData> mesh;
  int revision = 1;                    ///< version of the format: 1 for hapticd-model/1, 2 for hapticd-model/2
  bool swings = false, damps = false;  ///< true if some point has mass; if some point has damping
  bool layered = false;                ///< true if the stiffness was converted from young, poisson and thickness
  std::vector<std::string> odd;        ///< warnings of warnOfMedialFile()
};

/// Material of all vertices if the file gives none. The damping in a file is at most ten times this damping, or 5 N s/m
/// if that is more, because the host takes the parameter as the damping that the body claims.
struct Material {
  double stiffness = 0, damping = 0, mass = 0;  ///< [N/m], [N s/m], [kg]
  /// [m] radius of the flat tip for which Young's modulus is converted into a stiffness
  double tip = 5e-3;
};

/// [main] Reads the body of a file. If the name ends in .ma, the file is a medial mesh in the format of the literature
/// (ma_file.hpp); otherwise it is a model file (hapticd-model/1 or /2, YAML or JSON) with the key `medial`. This key
/// has either points, radius and stiffness as grids of equal rows, or vertices, edges and triangles with a stiffness;
/// damping and mass are optional. One number can stand for all points. Instead of stiffness a file may give young [Pa],
/// poisson and thickness [m], which layerStiffness() converts. @throws ModelFileError with every problem found, one
/// line each, for every possible content of the file.
MedialFile readMedialFile(const std::string& path, const Material& material);

/// [main] Does the same as readMedialFile() for the text of a file. `name` appears in messages, and its ending gives
/// the format.
MedialFile parseMedialFile(const std::string& text, const std::string& name, const Material& material);

/// [main] Returns the body that a point feels as a ball of `radius` [m] feels the body of `file`: the balls of which it
/// consists are larger by this radius.
MedialFile grownBy(double radius, MedialFile file);

/// [main] Returns a body that is `factor` times as stiff. Damping and mass stay. @throws std::invalid_argument if a
/// stiffness becomes larger than a file may give
MedialFile stiffened(double factor, MedialFile file);

}  // namespace hapticd
