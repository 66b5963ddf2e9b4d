// SPDX-License-Identifier: MIT
#include "kernels/medial/soft_weights.hpp"

#include <algorithm>

namespace hapticd::medial {
namespace {

using Eigen::Array3d;
using Eigen::Vector3d;

constexpr double kAtCorner = 1e-60;  ///< a foot counts as on a corner if a product of its weights is below this

/// A value on a slab, and its gradient over the three barycentric weights.
struct Field {
  double value = 0;
  Array3d gradient = Array3d::Zero();
};

/// Returns a value that rises from 0 to 1 as t does, with zero slope at both ends.
double smooth(double t) noexcept {
  return t * t * (3 - 2 * t);
}

/// Returns the share of an edge's second corner at the point of the edge that is nearest to a foot with the weights b.
/// This share has no slope across the edge.
Field shareAlong(const std::array<Vector3d, 3>& centers, std::size_t edge, const Array3d& b) noexcept {
  const std::size_t first = edge, second = (edge + 1) % 3, opposite = (edge + 2) % 3;
  const Vector3d along = centers[second] - centers[first];
  const double length2 = along.squaredNorm();
  const double foot = length2 > 0 ? along.dot(centers[opposite] - centers[first]) / length2 : 0;
  const auto at = [](std::size_t i) { return static_cast<Eigen::Index>(i); };
  const double t = b[at(second)] + foot * b[at(opposite)];
  Field share{smooth(std::clamp(t, 0.0, 1.0)), Array3d::Zero()};
  if (!(t > 0 && t < 1)) return share;
  const double slope = 6 * t * (1 - t);
  share.gradient[at(second)] = slope;
  share.gradient[at(opposite)] = slope * foot;
  return share;
}

/// Returns the weight of an edge before the weights are scaled to a sum of 1. On the edge itself only this edge counts.
/// Near another edge its weight falls at least with the square of the distance, so that it adds no slope there.
Field countOf(std::size_t edge, const Array3d& b) noexcept {
  const auto first = static_cast<Eigen::Index>(edge), second = static_cast<Eigen::Index>((edge + 1) % 3);
  const double product = b[first] * b[second];
  Field count{product * product, Array3d::Zero()};
  count.gradient[first] = 2 * product * b[second];
  count.gradient[second] = 2 * product * b[first];
  return count;
}

/// Adds `count` times `share` to the weight of a corner.
void add(const Field& count, const Field& share, Field& corner) noexcept {
  corner.value += count.value * share.value;
  corner.gradient += count.value * share.gradient + share.value * count.gradient;
}

CornerWeights onCorner(const Array3d& b) noexcept {
  Eigen::Index nearest = 0;
  b.maxCoeff(&nearest);
  CornerWeights weights;
  weights.value[static_cast<std::size_t>(nearest)] = 1;
  return weights;
}

}  // namespace

CornerWeights softOnCone(double t) noexcept {
  t = std::clamp(t, 0.0, 1.0);
  const double slope = 6 * t * (1 - t);
  return {{smooth(1 - t), smooth(t), 0}, {-slope, slope, 0}, {}};
}

/// Blends the results of the single edges by their weights.
CornerWeights softOnSlab(const std::array<Vector3d, 3>& centers, double u, double v) noexcept {
  const Array3d b = Array3d(1 - u - v, u, v).cwiseMax(0.0);
  std::array<Field, 3> corners;
  Field whole;
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const Field count = countOf(edge, b), second = shareAlong(centers, edge, b);
    add(count, second, corners[(edge + 1) % 3]);
    add(count, {1 - second.value, -second.gradient}, corners[edge]);
    whole.value += count.value;
    whole.gradient += count.gradient;
  }
  if (!(whole.value > kAtCorner)) return onCorner(b);
  CornerWeights weights;
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = corners[i].value / whole.value;
    const Array3d gradient = (corners[i].gradient - value * whole.gradient) / whole.value;
    weights.value[i] = value;
    weights.along_u[i] = gradient[1] - gradient[0];
    weights.along_v[i] = gradient[2] - gradient[0];
  }
  return weights;
}

CornerWeights weightsTowardEnds(const MedialMesh& mesh, const std::vector<uint8_t>& ends, uint32_t element,
                                const Eigen::Array2d& parameter) noexcept {
  const MedialMesh::Element& corners = mesh.elements()[element];
  if (corners.count < 2) return {{1, 0, 0}, {}, {}};
  CornerWeights weights{mesh.weights(element, parameter), {-1, 1, 0}, {}};
  if (corners.count > 2) weights.along_v = {-1, 0, 1};
  const auto isEnd = [&](std::size_t i) { return i < corners.count && ends[corners.vertex[i]] != 0; };
  if (!isEnd(0) && !isEnd(1) && !isEnd(2)) return weights;
  const auto center = [&](std::size_t i) -> const Vector3d& { return mesh.vertices()[corners.vertex[i]].center; };
  const CornerWeights soft = corners.count < 3
                                 ? softOnCone(parameter[0])
                                 : softOnSlab({center(0), center(1), center(2)}, parameter[0], parameter[1]);
  // share of the soft weights: the sum of soft weights of the ends, which has no slope there
  double share = 0, share_u = 0, share_v = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!isEnd(i)) continue;
    share += soft.value[i];
    share_u += soft.along_u[i];
    share_v += soft.along_v[i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double apart = soft.value[i] - weights.value[i];
    weights.value[i] += share * apart;
    weights.along_u[i] += share * (soft.along_u[i] - weights.along_u[i]) + share_u * apart;
    weights.along_v[i] += share * (soft.along_v[i] - weights.along_v[i]) + share_v * apart;
  }
  return weights;
}

}  // namespace hapticd::medial
