// SPDX-License-Identifier: MIT
#include "kernels/brep/next_faces.hpp"

namespace hapticd::brep {

std::uint32_t smoothlyBeyond(const Part& part, std::uint32_t edge, std::uint32_t face) noexcept {
  if (part.edges[edge].kind != EdgeKind::kSmooth || part.edges[edge].coedge_count != 2) return kNone;
  const Coedge& a = part.coedges[part.edges[edge].first_coedge];
  const Coedge& b = part.coedges[a.next];
  return a.face == face ? b.face : (b.face == face ? a.face : kNone);
}

}  // namespace hapticd::brep
