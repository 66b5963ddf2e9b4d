// SPDX-License-Identifier: MIT
#include "drawing/clusters.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "drawing/numbering.hpp"

namespace hapticd::drawing {
namespace {

constexpr std::uint32_t kMostCells = 1u << 20;  ///< most cubes along an axis
constexpr int kDirectionShift = 28;             ///< bit of a key's first word where the direction begins

/// Returns which of the six axes a vector is nearest to. Of equally near ones it is the first.
std::uint32_t directionOf(const Eigen::Vector3f& up) {
  Eigen::Index axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  return 2 * static_cast<std::uint32_t>(axis) + (up[axis] < 0 ? 1 : 0);
}

/// Returns the three clusters of a triangle, beginning with the smallest: the same for each of its corners as the
/// first.
Numbering::Key rotated(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a <= b && a <= c) return {a, b, c};
  if (b <= a && b <= c) return {b, c, a};
  return {c, a, b};
}

void groupPlaces(const WeldedMesh& mesh, double cell, Clusters& clusters) {
  Numbering numbers(mesh.places.size());
  clusters.of.reserve(mesh.places.size());
  for (std::size_t i = 0; i < mesh.places.size(); ++i) {
    Numbering::Key key{};
    for (int axis = 0; axis < 3; ++axis)
      key[static_cast<std::size_t>(axis)] =
          static_cast<std::uint32_t>((static_cast<double>(mesh.places[i][axis]) - mesh.low[axis]) / cell);
    key[0] |= directionOf(mesh.up[i]) << kDirectionShift;
    clusters.of.push_back(numbers(key));
  }
  clusters.count = numbers.count();
}

}  // namespace

Clusters clustersOf(const WeldedMesh& mesh, double cell) {
  Clusters clusters;
  groupPlaces(mesh, cell, clusters);
  Numbering known(mesh.triangles());
  std::vector<bool> drawn(clusters.count, false);
  const auto cornersOf = [&](std::size_t t) {
    return std::array<std::uint32_t, 3>{clusters.of[mesh.corners[3 * t]], clusters.of[mesh.corners[3 * t + 1]],
                                        clusters.of[mesh.corners[3 * t + 2]]};
  };
  for (std::size_t t = 0; t < mesh.triangles(); ++t) {
    const auto [a, b, c] = cornersOf(t);
    if (a == b || b == c || c == a || known(rotated(a, b, c)) != clusters.triangles.size()) continue;
    clusters.triangles.push_back(static_cast<std::uint32_t>(t));
    drawn[a] = drawn[b] = drawn[c] = true;
  }
  for (std::size_t t = 0; t < mesh.triangles(); ++t) {
    const auto [a, b, c] = cornersOf(t);
    if (drawn[a] && drawn[b] && drawn[c]) continue;
    clusters.lone.push_back(static_cast<std::uint32_t>(t));
    drawn[a] = drawn[b] = drawn[c] = true;
  }
  return clusters;
}

Clusters finestClusters(const WeldedMesh& mesh, std::size_t most) {
  constexpr int kMostPasses = 16, kGuesses = 4;
  constexpr double kEnough = 0.8;  // share of `most` that is near enough to it
  const double size = std::max((mesh.high - mesh.low).maxCoeff(), 1e-9);
  const double finest = size / (kMostCells - 1), coarsest = 1.01 * size;
  // a grid of squares on a flat surface leaves two triangles each; on a bent one it leaves about a third more
  const double guess = std::sqrt(2.6 * mesh.area / static_cast<double>(most));
  double cell = most >= mesh.triangles() ? finest : std::clamp(guess, finest, coarsest);
  double fits = coarsest, too_fine = finest;
  Clusters best;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    Clusters clusters = clustersOf(mesh, cell);
    const double share = static_cast<double>(clusters.drawn()) / static_cast<double>(most);
    (share <= 1 ? fits : too_fine) = cell;
    if (share <= 1) best = std::move(clusters);
    if (share <= 1 && (share >= kEnough || cell <= finest)) return best;
    // The number of triangles falls about with the square of the cell. A step beyond what is known is halved instead,
    // and so is one for a model of which that is not true, such as dust: all of it stays until the cells hold many
    // grains.
    const double next = cell * std::sqrt(share / (0.5 + 0.5 * kEnough));
    const bool guessed = pass < kGuesses && next > too_fine && next < fits;
    cell = guessed ? next : std::sqrt(too_fine * fits);
  }
  return best.count > 0 ? best : clustersOf(mesh, coarsest);
}

}  // namespace hapticd::drawing
