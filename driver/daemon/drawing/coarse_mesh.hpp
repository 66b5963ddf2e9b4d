// SPDX-License-Identifier: MIT
/// A coarser drawing of a mesh, for a page or an answer that cannot take all of its triangles. What is felt does not
/// change. The same mesh gives the same drawing on every machine.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drawing/welded_mesh.hpp"
#include "hapticd/shape.h"

namespace hapticd::drawing {

struct CoarseMesh {
  std::vector<float> xyz, normals;     ///< as in hsp_mesh; no normals if the plugin gave none
  std::vector<std::uint32_t> indices;  ///< as in hsp_mesh
  std::vector<std::uint32_t> colours;  ///< as in hsp_mesh; empty if the plugin gave none
  /// [m] Each corner of the plugin's triangles is that near to the drawing. Each corner of the drawing is one of the
  /// plugin's.
  double off = 0;

  /// [any] Returns the same as the plugin would; valid as long as this object is not changed.
  hsp_mesh view() const;
};

class MeshReducer {
 public:
  /// [main] @param mesh of a plugin, as host::ShapeInstance has checked it; it must outlive the reducer
  explicit MeshReducer(const hsp_mesh& mesh) : mesh_(mesh), welded_(weld(mesh)) {}

  /// [main] Returns a drawing of at most that many triangles. @param most at least 100
  CoarseMesh reduce(std::size_t most) const;

 private:
  const hsp_mesh& mesh_;
  WeldedMesh welded_;
};

}  // namespace hapticd::drawing
