// SPDX-License-Identifier: MIT
/// A model as it looks now, for a viewer at the other end of the control socket.
#pragma once
#include <string>

#include "base/descriptors.hpp"
#include "base/result.hpp"
#include "host/shape_instance.hpp"

namespace hapticd::servo {

/// [main] The triangles of an active model in its own frame, a soft body's as it is pressed now: one line of JSON with
/// xyz [m] and triangles, both flat lists. @param tolerance chord error [m]; 0: 5/1000 of the model's size. Fails if
/// the model has no triangles, or more than one answer may hold.
Result<std::string> geometryAnswer(const host::ShapeInstance& shape, double tolerance);

/// [main] The same as read-only memory, whose size only the machine bounds: f32 xyz [m], then f32 unit normals of the
/// model where it has such ("normals" of the answer), then u32 triangles. The answer is one line of JSON: bytes,
/// vertices, triangles, normals, tolerance. @param memory gets the descriptor
Result<std::string> geometryInMemory(const host::ShapeInstance& shape, double tolerance, Descriptor& memory);

/// [main] The newest vertices that the steps of an active model have written, one line of JSON: frame, counted from 1,
/// and xyz [m], in the model's frame and the order of geometryAnswer() at tolerance 0; without xyz where that frame is
/// not newer than `after`. More are written for a second after each call. Fails where the model's steps write none.
Result<std::string> verticesAnswer(const host::ShapeInstance& shape, double after);

/// [main] The name of a feature of an active model's contacts, one line of JSON; null where it has none.
std::string featureAnswer(const host::ShapeInstance& shape, uint32_t feature);

}  // namespace hapticd::servo
