// SPDX-License-Identifier: MIT
/// Model files of soft bodies: the grid or the mesh of a medial axis.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "kernels/medial/mesh_body.hpp"

namespace hapticd {

inline constexpr double kFarthestPoint = 1e6;  ///< [m] of points and radii: squares of larger ones leave no digits

/// What a file says of a body: a grid or a mesh.
struct MedialFile {
  std::optional<medial::BodyData> grid;
  std::optional<medial::MeshBodyData> mesh;
  int revision = 1;                    ///< of the format: hapticd-model/1 or /2
  bool swings = false, damps = false;  ///< some point has mass, some has damping
  std::vector<std::string> odd;        ///< what can hardly be meant: adviseMedial()
};

/// Material of all vertices where the file has none. The file may damp ten times as much at most, or 5 N s/m: the host
/// takes the parameter for what a body claims.
struct Material {
  double stiffness = 0, damping = 0, mass = 0;  ///< [N/m], [N s/m], [kg]
  double tip = 5e-3;                            ///< [m] radius of the flat tip that Young's modulus is felt with
};

/// [main] Reads the body of a file: a medial mesh in the field's own format if its name ends in .ma (ma_file.hpp), else
/// `medial` of a model file (format hapticd-model/1), YAML or JSON. That has either points, radius and stiffness as
/// grids of equal rows, or vertices, edges and triangles; damping and mass too where they are given. One number serves
/// all points. In place of stiffness a file may have young [Pa], poisson and thickness [m]: layerStiffness() of them.
/// @throws ModelFileError with every problem found, a line each; whatever the bytes of the file.
MedialFile readMedialFile(const std::string& path, const Material& material);

/// [main] The same from the text of a file; `name` stands in messages and tells the format.
MedialFile parseMedialFile(const std::string& text, const std::string& name, const Material& material);

}  // namespace hapticd
