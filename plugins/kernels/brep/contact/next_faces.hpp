// SPDX-License-Identifier: MIT
/// Which faces are next to a face, for a held contact whose foot comes to an edge or a vertex.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "kernels/brep/model/model.hpp"

namespace hapticd::brep {

/// A few faces that a tick has come to, in the order in which it has.
class FaceSet {
 public:
  static constexpr std::size_t kMost = 16;

  /// [rt] @param most faces that the set takes: a tick has no time to search many
  explicit FaceSet(std::uint32_t first, std::size_t most = kMost) noexcept : faces_{first}, most_(most) {}
  /// [rt] Adds a face. Returns false if it is kNone or known, or if the set is full.
  bool add(std::uint32_t face) noexcept {
    const auto end = faces_.begin() + static_cast<std::ptrdiff_t>(count_);
    if (face == kNone || count_ == most_ || std::find(faces_.begin(), end, face) != end) return false;
    faces_[count_++] = face;
    return true;
  }
  std::uint32_t operator[](std::size_t i) const noexcept { return faces_[i]; }
  std::size_t count() const noexcept { return count_; }

 private:
  std::array<std::uint32_t, kMost> faces_;
  std::size_t count_ = 1, most_;
};

/// [rt] Calls see(edge) for the edges of a face, at most `most` of them. Returns how many these were.
template <class See>
int eachEdgeOf(const Part& part, std::uint32_t face, int most, const See& see) noexcept {
  int count = 0;
  for (std::uint32_t i = 0; i < part.faces[face].loop_count; ++i) {
    const Loop& loop = part.loops[part.faces[face].first_loop + i];
    for (std::uint32_t c = loop.first; c < loop.first + loop.count && count < most; ++c, ++count)
      see(part.coedges[c].edge);
  }
  return count;
}

/// [rt] Returns the face beyond an edge of a face if the edge is smooth, else kNone.
std::uint32_t smoothlyBeyond(const Part& part, std::uint32_t edge, std::uint32_t face) noexcept;

/// [rt] True if two faces (for a mesh, two triangles) of one body are the same or have a common vertex.
bool areTogether(const Model& model, const Body& body, std::uint32_t face, std::uint32_t other) noexcept;

}  // namespace hapticd::brep
