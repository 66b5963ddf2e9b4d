// SPDX-License-Identifier: MIT
/// Gives the corners of triangles the colours of the vertices of a file. Vertices at the same place are one point of
/// the mesh, but may have different colours.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace hapticd::importing {

class VertexColours {
 public:
  /// Called for each vertex of the file, in their order. @param colour 0: it has none
  void add(std::uint32_t colour);

  /// Gives the triangles that were added last the colours of their vertices. @param list vertices of the file, those
  /// below 0 are none @param points point of each vertex @param corners points of all triangles so far
  /// @param first the first of those that were added
  template <class Index>
  void paint(const std::vector<Index>& list, const std::vector<std::uint32_t>& points,
             const std::vector<std::array<std::uint32_t, 3>>& corners, std::size_t first) {
    if (vertex_.empty()) return;
    for (const Index index : list)
      if (index >= 0) note(static_cast<std::size_t>(index), points[static_cast<std::size_t>(index)]);
    take(corners, first);
  }

  /// Gives the triangles from `first` to before `end` one colour.
  void fill(std::size_t first, std::size_t end, std::uint32_t colour);

  /// Returns the colours of the corners of all triangles; nothing if there are none.
  std::vector<std::array<std::uint32_t, 3>> colours(std::size_t triangles) &&;

 private:
  void note(std::size_t vertex, std::uint32_t point);
  void take(const std::vector<std::array<std::uint32_t, 3>>& corners, std::size_t first);

  std::vector<std::uint32_t> vertex_;    ///< colour of each vertex; empty as long as none has one
  std::vector<std::uint32_t> at_point_;  ///< colour that each point has in the present polygon
  std::vector<std::array<std::uint32_t, 3>> corners_;
  std::size_t vertices_ = 0;
};

}  // namespace hapticd::importing
