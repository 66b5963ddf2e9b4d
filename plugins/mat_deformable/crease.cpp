// SPDX-License-Identifier: MIT
#include "crease.hpp"

#include <algorithm>

namespace hapticd {
namespace {

using medial::directness;
using medial::FeltPlace;
using medial::PlaceNode;

/// If 1 + cosine of the normals of two feet is below this, the feet are nearly on opposite sides of a sheet. The rival
/// then counts less, and not at all if the normals are opposite.
constexpr double kNoRival = 0.05;

}  // namespace

double rivalShare(const Track& track, double width) noexcept HSP_RT {
  const double reach = std::min(width, track.foot.depth);  // at the surface the rival adds nothing
  if (!(track.apart > 0) || !(reach > 0)) return 0;
  const double beside = 1 - (track.foot.depth - track.rival.depth) / reach;
  const double opposite = (1 + track.foot.normal.dot(track.rival.normal)) / kNoRival;
  return std::clamp(beside, 0.0, 1.0) * track.apart * std::clamp(opposite, 0.0, 1.0);
}

Felt feltInCrease(const Felt& felt, const Track& track, double width) noexcept HSP_RT {
  const double share = rivalShare(track, width) * directness(felt.normal.dot(track.foot.normal));
  if (!(share > 0)) return felt;
  const Eigen::Vector3d gradient = felt.normal + 0.5 * share * (track.rival.normal - felt.normal);
  const double length = gradient.norm();
  if (!(length > 0)) return felt;
  const double reach = std::min(width, track.foot.depth);
  return {gradient / length, felt.depth + 0.25 * share * share * reach, length, share};
}

void mixPlaces(const FeltPlace& other, double share, FeltPlace& place) noexcept HSP_RT {
  const std::size_t count = place.count;
  for (std::size_t i = 0; i < count; ++i) {
    PlaceNode& part = place.nodes[i];
    part.weight *= 1 - share, part.weight_u *= 1 - share, part.weight_v *= 1 - share;
  }
  for (std::size_t i = 0; i < other.count; ++i) {
    const PlaceNode& part = other.nodes[i];
    const auto end = place.nodes.begin() + static_cast<std::ptrdiff_t>(count);
    const auto found = std::find_if(place.nodes.begin(), end, [&](const PlaceNode& n) { return n.node == part.node; });
    if (found != end) {
      found->weight += share * part.weight;
    } else if (place.count < FeltPlace::kMost) {
      place.nodes[place.count++] = {part.node, share * part.weight, 0, 0};
    }
  }
  place.stiffness += share * (other.stiffness - place.stiffness);
}

}  // namespace hapticd
