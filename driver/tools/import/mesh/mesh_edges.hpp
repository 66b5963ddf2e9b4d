// SPDX-License-Identifier: MIT
/// The edges of triangles, sorted so that all entries of one edge stand next to each other.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace hapticd::importing {

/// The triangles of a mesh while it is repaired.
struct MeshTriangles {
  std::vector<std::array<std::uint32_t, 3>> corners;
  std::vector<std::uint32_t> from;  ///< the triangle of the file from which each one comes

  /// Removes the triangles for which drop(index) is true. Returns how many these are.
  template <class Drop>
  std::size_t eraseIf(const Drop& drop) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < corners.size(); ++t) {
      if (drop(t)) continue;
      corners[kept] = corners[t];
      from[kept++] = from[t];
    }
    const std::size_t removed = corners.size() - kept;
    corners.resize(kept);
    from.resize(kept);
    return removed;
  }
};

struct MeshEdge {
  std::uint64_t ends;  ///< indices of the two points: the smaller in the upper 32 bits, the larger in the lower 32 bits
  std::uint32_t code;  ///< 4 * triangle + edge
};

/// [main] Returns the edges of all triangles, sorted by their points.
inline std::vector<MeshEdge> meshEdges(const std::vector<std::array<std::uint32_t, 3>>& corners) {
  std::vector<MeshEdge> edges;
  edges.reserve(3 * corners.size());
  for (std::uint32_t t = 0; t < corners.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[t][k], b = corners[t][(k + 1) % 3];
      edges.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), 4 * t + k});
    }
  std::sort(edges.begin(), edges.end(),
            [](const MeshEdge& a, const MeshEdge& b) { return a.ends != b.ends ? a.ends < b.ends : a.code < b.code; });
  return edges;
}

/// [any] Returns the index behind the last entry of the edge whose first entry is `i`.
inline std::size_t endOfEdge(const std::vector<MeshEdge>& edges, std::size_t i) {
  std::size_t end = i + 1;
  while (end < edges.size() && edges[end].ends == edges[i].ends) ++end;
  return end;
}

/// [main] Returns the neighbours, indexed by 3 * triangle + edge: the code of the other triangle if the edge has
/// exactly two triangles, else 0xffffffff.
inline std::vector<std::uint32_t> pairedNeighbours(const std::vector<MeshEdge>& edges, std::size_t triangles) {
  std::vector<std::uint32_t> across(3 * triangles, 0xffffffffu);
  for (std::size_t i = 0; i < edges.size();) {
    const std::size_t end = endOfEdge(edges, i);
    if (end - i == 2) {
      const std::uint32_t a = edges[i].code, b = edges[i + 1].code;
      across[3 * (a / 4) + a % 4] = b;
      across[3 * (b / 4) + b % 4] = a;
    }
    i = end;
  }
  return across;
}

}  // namespace hapticd::importing
