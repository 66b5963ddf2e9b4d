// SPDX-License-Identifier: MIT
#include "traced_shape/other_solids.hpp"

namespace hapticd {

bool OtherSolids::hold(const Eigen::Vector3d& point, const brep::Placement& place) {
  const std::vector<brep::Placement>& places = part_.placements();
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    const brep::Placement& other = places[i];
    if (!other.solid || other.instance == place.instance) continue;
    if (!part_.body(other.body).tree.bounds().contains(other.toBody(point))) continue;
    const brep::Nearest near = search_.nearestOf(i, brep::kNone, point, brep::Hit{});
    if (!near.found()) continue;
    const std::uint32_t face = brep::faceOf(part_, near.hit, brep::kNone);
    if (brep::describe(part_, i, near.hit, face, point).depth > 0) return true;
  }
  return false;
}

}  // namespace hapticd
