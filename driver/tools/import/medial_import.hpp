// SPDX-License-Identifier: MIT
/// `hapticd import --medial`: makes a soft body from a closed surface.
#pragma once
#include <string>

#include "base/result.hpp"
#include "host/catalog.hpp"
#include "import/bezier_import.hpp"
#include "import/triangles.hpp"

namespace hapticd::importing {

struct MedialImport {
  std::string file, out;
  Placement placement;
  double tolerance = 0;  ///< [m] tolerance of the medial axis; 0 means a hundredth of the body's size
  int samples = 20000;   ///< number of points on the surface
  int most_spheres = 2000;
  double least_angle = 60;  ///< [degrees] see MedialOptions
  double stiffness = 300, damping = 0.5;
  double mass = -1;  ///< [kg] of a vertex; negative: 0.01, and 2 kg in all at most
  /// [Pa], 1, [m] of a layer of tissue, instead of the stiffness; young 0: not given
  double young = 0, poisson = 0.45, thickness = 0;
};

/// [main] Reads the closed surface of `options.file` and brings it to its place. An error means that the file or a file
/// name is wrong.
Result<Triangles> readSurface(const MedialImport& options, host::Catalog& catalog);

/// [main] Finds the medial axis, writes `options.out` and measures the written body. Reports progress on standard error
/// and the result on standard output.
Result<void> importMedial(const MedialImport& options, const Triangles& mesh, host::Catalog& catalog);

}  // namespace hapticd::importing
