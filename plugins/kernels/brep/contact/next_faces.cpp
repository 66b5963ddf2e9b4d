// SPDX-License-Identifier: MIT
#include "kernels/brep/contact/next_faces.hpp"

#include <limits>

namespace hapticd::brep {
namespace {

bool isOn(const Part& part, std::uint32_t edge, std::uint32_t face) noexcept {
  for (std::uint32_t c = part.edges[edge].first_coedge; c != kNone; c = part.coedges[c].next)
    if (part.coedges[c].face == face) return true;
  return false;
}

}  // namespace

std::uint32_t smoothlyBeyond(const Part& part, std::uint32_t edge, std::uint32_t face) noexcept {
  if (part.edges[edge].kind != EdgeKind::kSmooth || part.edges[edge].coedge_count != 2) return kNone;
  const Coedge& a = part.coedges[part.edges[edge].first_coedge];
  const Coedge& b = part.coedges[a.next];
  return a.face == face ? b.face : (b.face == face ? a.face : kNone);
}

bool areTogether(const Model& model, const Body& body, std::uint32_t face, std::uint32_t other) noexcept {
  if (face == other) return true;
  const Part& part = model.part();
  if (body.kind == BodyKind::kMesh) {
    const auto &a = part.triangles[face].corner, &b = part.triangles[other].corner;
    return std::any_of(a.begin(), a.end(),
                       [&](std::uint32_t at) { return std::find(b.begin(), b.end(), at) != b.end(); });
  }
  bool found = false;
  eachEdgeOf(part, face, std::numeric_limits<int>::max(), [&](std::uint32_t edge) {
    found = found || isOn(part, edge, other);
    for (const std::uint32_t vertex : {part.edges[edge].first_vertex, part.edges[edge].last_vertex})
      if (vertex != kNone && !found)
        for (const std::uint32_t at : model.edgesAt(vertex)) found = found || isOn(part, at, other);
  });
  return found;
}

}  // namespace hapticd::brep
