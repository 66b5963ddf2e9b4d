// SPDX-License-Identifier: MIT
#include "traced_shape/other_solids.hpp"

namespace hapticd {
namespace {

constexpr int kMostBodies = 20;

/// Returns a part with only one body, placed at its own frame.
brep::Part aloneIn(brep::Part part, std::uint32_t body) {
  brep::Instance instance;
  instance.body = body;
  part.instances = {instance};
  return part;
}

}  // namespace

bool OtherSolids::hold(const Eigen::Vector3d& point, const brep::Placement& place) {
  for (const brep::Placement& other : part_.placements()) {
    if (!other.solid || other.instance == place.instance) continue;
    const Eigen::Vector3d p = other.toBody(point);
    if (!part_.body(other.body).tree.bounds().contains(p)) continue;
    std::unique_ptr<Alone>& alone = alone_[other.body];
    if (alone == nullptr && ++made_ > kMostBodies) return true;
    if (alone == nullptr) alone = std::make_unique<Alone>(aloneIn(part_.part(), other.body));
    if (alone->tracer.nearest(p).depth > 0) return true;
  }
  return false;
}

}  // namespace hapticd
