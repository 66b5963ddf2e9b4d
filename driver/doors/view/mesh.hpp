// SPDX-License-Identifier: MIT
/// Meshes and vertices as they go to a page: little-endian words, then the numbers, nothing encoded as text.
///
///     mesh:      u32 0x80000000, vertices, triangles, flags (1: normals follow), f32 xyz, [f32 normals], u32 corners
///     vertices:  u32 0x100 + model, frame, vertices, 0, f32 xyz
///     rows:      u32 stream, row_bytes, count, 0, rows
#pragma once
#include <cstdint>
#include <span>

#include "daemon.hpp"
#include "peer.hpp"

namespace hapticd::view {

constexpr uint32_t kMeshMessage = 0x80000000u, kVerticesMessage = 0x100;

/// [main] From an answer of `geometry` as memory. nullptr if it is not one, or the memory is shorter than it says.
Message meshMessage(const Json& answer, int memory);

/// [main] Only the vertices of such an answer, for a body that deforms. nullptr in the same cases.
Message verticesMessage(const Json& answer, int memory, uint32_t model, uint32_t frame);

/// [main] From an answer of `vertices`. nullptr if it has no vertices.
Message verticesMessage(const Json& answer, uint32_t model);

/// [main] A message that begins with four words.
std::string headed(uint32_t a, uint32_t b, uint32_t c, uint32_t d, size_t reserve = 0);

}  // namespace hapticd::view
