// SPDX-License-Identifier: MIT
/// Triangles of parts, for drawing and for their volume.
#pragma once
#include "kernels/brep/model.hpp"
#include "traced_shape/mesh.hpp"

namespace hapticd {

/// [main] Triangles within about `chord_error` [m] of all faces of a part, where they stand in the model.
Mesh tessellate(const brep::Model& model, double chord_error);

}  // namespace hapticd
