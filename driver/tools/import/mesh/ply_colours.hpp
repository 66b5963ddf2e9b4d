// SPDX-License-Identifier: MIT
/// The colours of a PLY file: red, green and blue of vertices or of faces. Those of a face come before those of its
/// vertices.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "mesh_import/ply_body.hpp"

namespace hapticd::importing::ply {

class Colours {
 public:
  void beginItem() { seen_ = 0; }

  /// Takes a value of an item, if it is one of a colour.
  void see(std::string_view name, Type type, double value);

  /// Called for each vertex, in their order.
  void endVertex();

  /// Gives the triangles that were added last the colours of their vertices. @param list vertices of the file, -1 for
  /// none @param points point of each vertex @param corners points of all triangles so far @param first the first of
  /// those that were added
  void paint(const std::vector<double>& list, const std::vector<std::uint32_t>& points,
             const std::vector<std::array<std::uint32_t, 3>>& corners, std::size_t first);

  /// Called at the end of a face or of strips: gives its triangles, from `first` to before `end`, its colour, if it has
  /// one.
  void endFace(std::size_t first, std::size_t end);

  /// Returns the colours of the corners of all triangles; nothing if there are none.
  std::vector<std::array<std::uint32_t, 3>> take(std::size_t triangles);

 private:
  static constexpr unsigned kAll = 7;
  std::uint32_t word() const;

  std::array<double, 3> share_{};        ///< 0 to 1: of this item
  unsigned seen_ = 0;                    ///< bit k: share_[k] has come
  std::vector<std::uint32_t> vertex_;    ///< colour of each vertex; empty as long as none has one
  std::vector<std::uint32_t> at_point_;  ///< colour that each point has in the present polygon
  std::vector<std::array<std::uint32_t, 3>> corners_;
  std::size_t vertices_ = 0;
};

}  // namespace hapticd::importing::ply
