// SPDX-License-Identifier: MIT
#include "mesh_import/ply_colours.hpp"

#include <algorithm>

#include "mesh_import/mesh_colours.hpp"

namespace hapticd::importing::ply {
namespace {

/// Returns the value that means full colour.
double fullOf(Type type) {
  if (type == Type::kFloat || type == Type::kDouble) return 1;
  return type == Type::kUint16 ? 65535 : 255;
}

}  // namespace

void Colours::see(std::string_view name, Type type, double value) {
  constexpr std::string_view kNames[] = {"red", "green", "blue"};
  for (unsigned k = 0; k < 3; ++k) {
    if (name != kNames[k]) continue;
    share_[k] = value / fullOf(type);
    seen_ |= 1u << k;
  }
}

std::uint32_t Colours::word() const {
  return seen_ == kAll ? colourWord(share_[0], share_[1], share_[2]) : 0;
}

void Colours::endVertex() {
  const std::uint32_t colour = word();
  if (colour != 0 || !vertex_.empty()) vertex_.resize(vertices_, 0), vertex_.push_back(colour);
  ++vertices_;
}

void Colours::paint(const std::vector<double>& list, const std::vector<std::uint32_t>& points,
                    const std::vector<std::array<std::uint32_t, 3>>& corners, std::size_t first) {
  if (vertex_.empty()) return;
  corners_.resize(first);  // those before may have no colours
  for (const double index : list) {
    if (index < 0) continue;
    const auto vertex = static_cast<std::size_t>(index);
    if (points[vertex] >= at_point_.size()) at_point_.resize(points[vertex] + 1, 0);
    at_point_[points[vertex]] = vertex < vertex_.size() ? vertex_[vertex] : 0;
  }
  for (std::size_t t = first; t < corners.size(); ++t)
    corners_.push_back({at_point_[corners[t][0]], at_point_[corners[t][1]], at_point_[corners[t][2]]});
}

void Colours::endFace(std::size_t first, std::size_t end) {
  const std::uint32_t colour = word();
  if (colour == 0) return;
  corners_.resize(end);
  std::fill(corners_.begin() + static_cast<std::ptrdiff_t>(first), corners_.end(), std::array{colour, colour, colour});
}

std::vector<std::array<std::uint32_t, 3>> Colours::take(std::size_t triangles) {
  if (!corners_.empty()) corners_.resize(triangles);
  return std::move(corners_);
}

}  // namespace hapticd::importing::ply
