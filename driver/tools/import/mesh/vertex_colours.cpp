// SPDX-License-Identifier: MIT
#include "mesh_import/vertex_colours.hpp"

#include <algorithm>
#include <utility>

namespace hapticd::importing {

void VertexColours::add(std::uint32_t colour) {
  if (colour != 0 || !vertex_.empty()) vertex_.resize(vertices_, 0), vertex_.push_back(colour);
  ++vertices_;
}

void VertexColours::note(std::size_t vertex, std::uint32_t point) {
  if (point >= at_point_.size()) at_point_.resize(point + 1, 0);
  at_point_[point] = vertex < vertex_.size() ? vertex_[vertex] : 0;
}

void VertexColours::take(const std::vector<std::array<std::uint32_t, 3>>& corners, std::size_t first) {
  corners_.resize(first);  // those before may have no colours
  for (std::size_t t = first; t < corners.size(); ++t)
    corners_.push_back({at_point_[corners[t][0]], at_point_[corners[t][1]], at_point_[corners[t][2]]});
}

void VertexColours::fill(std::size_t first, std::size_t end, std::uint32_t colour) {
  corners_.resize(end);
  std::fill(corners_.begin() + static_cast<std::ptrdiff_t>(first), corners_.end(), std::array{colour, colour, colour});
}

std::vector<std::array<std::uint32_t, 3>> VertexColours::colours(std::size_t triangles) && {
  if (!corners_.empty()) corners_.resize(triangles);
  return std::move(corners_);
}

}  // namespace hapticd::importing
