// SPDX-License-Identifier: MIT
/// Empty balls: balls that touch a triangle of a mesh and hold nothing else of the mesh. A smaller ball that touches at
/// the same point is inside and so empty as well. So the foot of its centre is that point, and a search need look at
/// nothing else. (Empty balls that touch a surface: Amenta and Bern 1999. The largest ones are the balls of its medial
/// axis.)
#pragma once
#include <cstddef>
#include <cstdint>

#include "kernels/brep/elements/elements.hpp"
#include "kernels/brep/geometry/triangle_foot.hpp"
#include "kernels/brep/tree/coarse.hpp"

namespace hapticd::brep {

struct BodyTree;

/// [rt] Returns a radius [m]: smaller balls that touch a triangle on one side hold no triangle but some that have a
/// corner in common with it.
inline double wholeRadius(const EmptyBalls& balls, bool back) noexcept {
  return static_cast<double>(Coarse::ofBits(balls.sides[back ? 1 : 0].whole).value());
}

/// [rt] Returns a radius [m]: each smaller ball is empty that touches the triangle at a foot in its interior. Where b
/// is the barycentric coordinate of the corner opposite of edge k, balls that are smaller than b times slope[k] hold
/// none of the triangles with a corner in common.
inline double emptyRadius(const EmptyBalls& balls, const Hit& foot, bool back) noexcept {
  const double along[3] = {foot.v, 1 - foot.u - foot.v, foot.u};
  double radius = wholeRadius(balls, back);
  for (std::size_t k = 0; k < 3; ++k) {
    const double limit = static_cast<double>(Coarse::ofBits(balls.sides[back ? 1 : 0].slope[k]).value()) * along[k];
    radius = limit < radius ? limit : radius;
  }
  return radius;
}

/// [rt] Visits the triangles around a corner of a triangle, over their edges. @param use is called with the index of
/// each but the first. Returns how many triangles there are, or 0 if they are not a closed ring, or too many.
template <class Use>
std::uint32_t aroundCorner(const Part& part, std::uint32_t triangle, std::uint32_t corner, const Use& use) noexcept {
  constexpr std::uint32_t kMost = 24;
  const std::uint32_t point = part.triangles[triangle].corner[corner];
  std::uint32_t at = triangle, edge = corner;  // both edges `corner` and the one before end at the corner
  for (std::uint32_t count = 1; count <= kMost; ++count) {
    const std::uint32_t code = part.triangles[at].across[edge];
    if (code == kNone) return 0;
    at = code / 4;
    if (at == triangle) return count;
    use(at);
    const auto& corners = part.triangles[at].corner;
    const std::uint32_t k = corners[0] == point ? 0 : corners[1] == point ? 1 : 2;
    edge = code % 4 == k ? (k + 2) % 3 : k;
  }
  return 0;
}

/// [main] Finds the empty balls of a mesh, Part::balls. It takes some microseconds for each triangle. @param tree over
/// the triangles of the mesh
void findEmptyBalls(Part& part, const BodyTree& tree);

/// [main] True if the part has the balls of a mesh: some of them are found again, and are the same.
bool hasEmptyBalls(const Part& part, const BodyTree& tree);

/// [main] Finds the empty balls of all meshes of a part, which its file then keeps.
void findEmptyBalls(Part& part);

}  // namespace hapticd::brep
