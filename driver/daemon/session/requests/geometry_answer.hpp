// SPDX-License-Identifier: MIT
/// Answers with the shape of a model as it is now, for programs that draw it.
#pragma once
#include <string>

#include "base/descriptors.hpp"
#include "base/result.hpp"
#include "host/shape_instance.hpp"
#include "session/requests/fitted_drawing.hpp"

namespace hapticd::servo {

/// [main] Returns the triangles of an active model in its own frame (those of a soft body in its present deformation):
/// one line of JSON with xyz [m] and triangles, both flat lists. A model with more triangles than fit into one answer
/// is drawn coarser, and a "note" says so. Fails if the model has no triangles, or if no drawing fits.
Result<std::string> geometryAnswer(const host::ShapeInstance& shape, const DrawingWish& wish);

/// [main] Returns the triangles in read-only memory, 64 MiB at most: f32 xyz [m], then f32 unit normals if the model
/// has them ("normals" in the answer), then u32 triangles, then u32 colours of the vertices if it has them ("colours").
/// The answer is one line of JSON: bytes, vertices, triangles, normals, colours, tolerance, and a "note" as in
/// geometryAnswer(). @param memory gets the descriptor of the memory
Result<std::string> geometryInMemory(const host::ShapeInstance& shape, const DrawingWish& wish, Descriptor& memory);

/// [main] Returns the newest vertices of an active model that deforms: one line of JSON with the number of the drawing
/// ("frame", counted from 1) and xyz [m], in the model's coordinates and in the order of geometryAnswer() at tolerance
/// 0. There is no xyz if the number is not larger than `after`. After each call the model writes new vertices for one
/// second. Fails if the model writes no vertices.
Result<std::string> verticesAnswer(const host::ShapeInstance& shape, double after);

/// [main] Returns the name of a feature of an active model, as one line of JSON; null if the feature has no name.
std::string featureAnswer(const host::ShapeInstance& shape, uint32_t feature);

}  // namespace hapticd::servo
