// SPDX-License-Identifier: MIT
/// Triangles of parts, for drawing and for their volume.
#pragma once
#include "kernels/brep/model/model.hpp"
#include "traced_shape/mesh.hpp"

namespace hapticd {

/// [main] Returns triangles that are within about `chord_error` [m] of all faces of a part, in the model frame.
Mesh tessellate(const brep::Model& model, double chord_error);

}  // namespace hapticd
