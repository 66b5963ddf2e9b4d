// SPDX-License-Identifier: MIT
/// The search among the triangles of a mesh that an earlier tick gathered around the probe.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kernels/brep/geometry/geometry.hpp"
#include "kernels/brep/search/search.hpp"
#include "kernels/brep/tree/lanes.hpp"

namespace hapticd::brep {

using Eigen::Vector3d;

namespace {

constexpr float kDone = std::numeric_limits<float>::infinity();

/// Lower bounds of numbered things, four side by side. Those that were examined are removed. It has no branches,
/// because on a mesh no processor can predict which triangles are near.
template <int kMost>
class Bounds {
 public:
  /// @param bound returns the bounds of four
  template <class Bound>
  Bounds(int fours, const Bound& bound) noexcept : count_(fours) {
    for (int k = 0; k < count_; ++k) bounds_[static_cast<std::size_t>(k)] = bound(k);
  }

  double at(int i) const noexcept { return static_cast<double>(bounds_[static_cast<std::size_t>(i / 4)][i % 4]); }
  void take(int i) noexcept { putLane(bounds_[static_cast<std::size_t>(i / 4)], i % 4, kDone); }
  /// Returns the least bound of what remains.
  double least() const noexcept {
    Float4 least = Float4{} + kDone;
    for (int k = 0; k < count_; ++k) least = lesser(bounds_[static_cast<std::size_t>(k)], least);
    return static_cast<double>(leastOf(least));
  }
  /// Returns the number with the least bound, the first one of several.
  int nearest() const noexcept {
    Float4 least = Float4{} + kDone;
    Test4 where{};
    for (int k = 0; k < count_; ++k) {
      const Float4& four = bounds_[static_cast<std::size_t>(k)];
      const Test4 closer = four < least;
      where = closer ? Test4{} + k : where;
      least = closer ? four : least;
    }
    const Test4 numbers = 4 * where + Test4{0, 1, 2, 3};
    const float value = leastOf(least);
    int first = 4 * count_;
    for (int lane = 0; lane < 4; ++lane) first = least[lane] == value && numbers[lane] < first ? numbers[lane] : first;
    return first < 4 * count_ ? first : 0;
  }
  /// Returns bit i of word w for each number 64 w + i that is within d2, or hardly farther.
  std::array<std::uint64_t, 2> within(double d2) const noexcept {
    static_assert(kMost <= 128);
    const Float4 limit = Float4{} + static_cast<float>(d2) * (1 + 1e-6F);  // rounded up
    std::array<std::uint64_t, 2> numbers{};
    for (int k = 0; k < count_; ++k)
      numbers[static_cast<std::size_t>(k / 16)] |= std::uint64_t{bitsOf(bounds_[static_cast<std::size_t>(k)] <= limit)}
                                                   << 4 * (k % 16);
    return numbers;
  }

 private:
  std::array<Float4, kMost / 4> bounds_;
  int count_;
};

/// The triangles that a tick has examined, with their rows and feet.
class Examined {
 public:
  void add(int row, Element triangle, const Vector3d& foot) noexcept {
    if (count_ < kMost) triangles_[static_cast<std::size_t>(count_)] = {row, triangle, foot};
    ++count_;
  }
  bool isComplete() const noexcept { return count_ <= kMost; }
  /// Gives each triangle a plane of its own, instead of that of its row.
  void teach(NearPlanes& planes, const Part& part, const Vector3d& p) const noexcept {
    for (int i = 0; i < count_; ++i) {
      const auto& [row, triangle, foot] = triangles_[static_cast<std::size_t>(i)];
      planes.dropRow(row);
      planes.learn(planes.add(triangle), p, foot, cornersOf(part, triangle.index()));
    }
  }

 private:
  struct One {
    int row;
    Element triangle;
    Vector3d foot;
  };
  static constexpr int kMost = NearPlanes::kMostTriangles / 2;
  std::array<One, kMost> triangles_;
  int count_ = 0;
};

}  // namespace

/// Examines those gathered rows whose discs are near enough, the nearest one first.
template <class Note>
void Search::examineDiscs(std::uint32_t place, const BoxProbe& probe, const Note& note, Run& run) noexcept {
  const BodyTree& body = model_.body(model_.placements()[place].body);
  const NearTriangles& near = near_triangles_;
  Bounds<NearTriangles::kMostRows> bounds(near.fours(), [&](int k) { return near.distances(k, probe); });
  run.best.nodes += near.fours();
  const auto examineWithin = [&](int at) {
    if (!(bounds.at(at) <= run.within2())) return;
    bounds.take(at);
    const ElementRow row = near.row(at / 4, at % 4);
    for (std::uint32_t i = row.first; i < row.first + row.count; ++i) note(at, body.elements[i]);
  };
  if (near.rows() > 0) examineWithin(bounds.nearest());  // it brings the limit down for the others
  const std::array<std::uint64_t, 2> rows = bounds.within(run.within2());
  for (std::size_t w = 0; w < 2; ++w)
    for (std::uint64_t left = rows[w]; left != 0; left &= left - 1)
      examineWithin(64 * static_cast<int>(w) + std::countr_zero(left));
  run.others2 = std::min(run.others2, bounds.least());
}

/// Examines the triangles of a mesh around the probe. For a slow probe it makes planes, which serve the next ticks.
template <>
void Search::examineRows(NearTriangles& near, std::uint32_t place, const Vector3d& p, Run& run) noexcept {
  constexpr double kSlow = 0.1, kServe = 0.8;  // shares of the radius of a row; a faster probe leaves planes too soon
  if (near_planes_.serve(p)) {
    examinePlanes(place, p, run);
    return;
  }
  near_planes_.forget();
  const Element first = run.first_place == place ? run.first : Element();
  const BoxProbe probe(model_.body(model_.placements()[place].body).tree, p);
  const double radius = near.rows() > 0 ? static_cast<double>(near.shapes(0).radius[0]) : 0;
  if (gathered_now_ || way_ > kSlow * radius) {  // a tick that gathers takes long enough without planes
    examineDiscs(
        place, probe,
        [&](int, Element element) {
          if (!(element == first)) examineTriangle(place, element, p, run);
        },
        run);
    return;
  }
  const Vector3d first_foot = run.best.hit.point;
  Examined examined;
  examineDiscs(
      place, probe,
      [&](int row, Element element) {
        examined.add(row, element, element == first ? first_foot : examineForFoot(place, element, p, run));
      },
      run);
  if (!examined.isComplete()) return;
  near_planes_.make(near, probe, p, kServe * radius);
  examined.teach(near_planes_, model_.part(), p);
}

/// Examines a triangle and learns its plane. @param plane number of the plane, or NearPlanes::kNowhere
void Search::examineBehind(int plane, std::uint32_t place, Element triangle, const Vector3d& p, Run& run) noexcept {
  const Vector3d foot = examineForFoot(place, triangle, p, run);
  if (plane == NearPlanes::kNowhere) return;
  near_planes_.learn(plane, p, foot, cornersOf(model_.part(), triangle.index()));
  if (run.best.hit.element == triangle) last_plane_ = plane;
}

/// Examines only what is not farther than the best foot by its plane, the nearest plane first.
void Search::examinePlanes(std::uint32_t place, const Vector3d& p, Run& run) noexcept {
  const BodyTree& body = model_.body(model_.placements()[place].body);
  NearPlanes& planes = near_planes_;
  const Element first = run.first_place == place ? run.first : Element();
  const Vector3d first_foot = run.best.hit.point;
  const auto learnFirst = [&](int plane) {
    planes.learn(plane, p, first_foot, cornersOf(model_.part(), first.index()));
  };
  const PlaneProbe probe = planes.probe(p);
  Bounds<NearPlanes::kMostPlanes> bounds(planes.fours(), [&](int k) { return planes.distances(k, probe); });
  run.best.nodes += planes.fours();
  const int first_plane = last_plane_ = planes.find(first, last_plane_);
  if (first_plane != NearPlanes::kNowhere) bounds.take(first_plane);
  double least = bounds.least();
  for (double limit = std::sqrt(run.within2()); least <= limit + NearPlanes::rounding(limit, probe);
       limit = std::sqrt(run.within2()), least = bounds.least()) {
    const int plane = bounds.nearest();
    bounds.take(plane);
    if (!planes.isRow(plane)) {
      examineBehind(plane, place, planes.triangle(plane), p, run);
      continue;
    }
    const bool kept = planes.hasRoom();
    const ElementRow row = near_triangles_.row(plane / 4, plane % 4);
    for (std::uint32_t i = row.first; i < row.first + row.count; ++i)
      if (const Element triangle = body.elements[i]; !(triangle == first))
        examineBehind(kept ? planes.add(triangle) : NearPlanes::kNowhere, place, triangle, p, run);
      else if (kept)
        learnFirst(planes.add(first));
    if (kept) planes.dropRow(plane);
  }
  if (first_plane != NearPlanes::kNowhere && !(run.best.hit.element == first)) learnFirst(first_plane);
  const double others = std::max(least - NearPlanes::rounding(least, probe), 0.0);
  run.others2 = std::min(run.others2, others * others);
}

}  // namespace hapticd::brep
