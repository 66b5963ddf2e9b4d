// SPDX-License-Identifier: MIT
#include "kernels/part/part.hpp"

namespace hapticd::brep {

void linkCoedges(Part& part) {
  for (Edge& edge : part.edges) {
    edge.first_coedge = kNone;
    edge.coedge_count = 0;
  }
  for (std::size_t i = part.coedges.size(); i-- > 0;) {  // backwards, so that each list is in ascending order
    Coedge& coedge = part.coedges[i];
    coedge.next = kNone;
    if (coedge.edge >= part.edges.size()) continue;
    Edge& edge = part.edges[coedge.edge];
    coedge.next = edge.first_coedge;
    edge.first_coedge = static_cast<std::uint32_t>(i);
    ++edge.coedge_count;
  }
}

}  // namespace hapticd::brep
