// SPDX-License-Identifier: MIT
/// Messages with meshes and vertices for a page. They are binary: little-endian words, then the numbers.
///
///     mesh:      u32 0x80000000, vertices, triangles, flags (1: normals, 2: colours), f32 xyz, [f32 normals],
///                u32 corners, [u32 colours of the vertices]
///     vertices:  u32 0x100 + model, frame, vertices, 0, f32 xyz
///     rows:      u32 stream, row_bytes, count, 0, rows
#pragma once
#include <cstdint>

#include "daemon.hpp"
#include "peer.hpp"

namespace hapticd::view {

/// Triangles that may be asked for in a drawing. The most take 50 MB if no two share a corner, which is less than may
/// wait for a page.
constexpr uint32_t kFewestTriangles = 1000, kMostTriangles = 600000;

constexpr uint32_t kMeshMessage = 0x80000000u, kVerticesMessage = 0x100;
constexpr uint32_t kHasNormals = 1, kHasColours = 2;  ///< flags of a mesh

/// [main] Makes a message from the daemon's answer to `geometry`, whose triangles are in `memory`. Returns nullptr if
/// the answer is wrong, or if the memory is shorter than the answer says.
Message meshMessage(const Json& answer, int memory);

/// [main] Makes a message with only the vertices of the answer to `geometry`, for a body that deforms. Returns nullptr
/// in the same cases as meshMessage().
Message verticesMessage(const Json& answer, int memory, uint32_t model, uint32_t frame);

/// [main] Makes a message from the daemon's answer to `vertices`. Returns nullptr if it has no vertices.
Message verticesMessage(const Json& answer, uint32_t model);

/// [main] Returns a message that begins with these four words, with room for `reserve` more bytes.
std::string headed(uint32_t a, uint32_t b, uint32_t c, uint32_t d, size_t reserve = 0);

}  // namespace hapticd::view
