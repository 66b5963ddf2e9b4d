// SPDX-License-Identifier: MIT
/// The search for a probe that is followed from tick to tick: it examines only some of the rows that an earlier tick
/// gathered around the probe.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kernels/brep/search/search.hpp"
#include "kernels/brep/tree/lanes.hpp"

namespace hapticd::brep {

using Eigen::Vector3d;

namespace {

constexpr float kTaken = std::numeric_limits<float>::infinity();

/// Lower bounds of the squared distances [m^2] to the gathered rows. Rows that were examined are removed.
template <class Near>
class RowBounds {
 public:
  RowBounds(const Near& rows, const BoxProbe& probe) noexcept : count_(rows.fours()) {
    for (int k = 0; k < count_; ++k) bounds_[static_cast<std::size_t>(k)] = rows.distances(k, probe);
  }

  double at(int k, int lane) const noexcept { return static_cast<double>(bounds_[static_cast<std::size_t>(k)][lane]); }
  void take(int k, int lane) noexcept { bounds_[static_cast<std::size_t>(k)][lane] = kTaken; }
  bool anyWithin(int k, double d2) const noexcept {
    const Float4& four = bounds_[static_cast<std::size_t>(k)];
    const Float4 limit = Float4{} + static_cast<float>(d2) * (1 + 1e-6F);  // rounded up
    const auto within = four <= limit;
    return (within[0] | within[1] | within[2] | within[3]) != 0;
  }
  /// Returns the least bound of the remaining rows.
  double least() const noexcept {
    Float4 least = Float4{} + kTaken;
    for (int k = 0; k < count_; ++k) {
      const Float4& four = bounds_[static_cast<std::size_t>(k)];
      least = four < least ? four : least;
    }
    return static_cast<double>(std::min(std::min(least[0], least[1]), std::min(least[2], least[3])));
  }
  /// Removes the row with the least bound. Returns 4 times its group of four plus its lane.
  int takeNearest() noexcept {
    taken_ = least();
    const auto value = static_cast<float>(taken_);
    for (int k = 0; k < count_; ++k) {
      if (!anyWithin(k, taken_)) continue;
      for (int lane = 0; lane < 4; ++lane)
        if (bounds_[static_cast<std::size_t>(k)][lane] <= value) {
          take(k, lane);
          return 4 * k + lane;
        }
    }
    return 0;
  }
  double taken() const noexcept { return taken_; }

 private:
  std::array<Float4, Near::kMostRows / 4> bounds_;
  int count_;
  double taken_ = 0;
};

/// Gathers the elements around p in a model of one placement; p is in the body's frame.
template <class Near>
bool gatherFrom(const Model& model, Near& near, const Vector3d& p, double reach) noexcept {
  return near.gather(model.body(model.placements()[0].body), p, reach);
}
/// Gathers the elements around p in a model of several placements; p is in the model's frame.
bool gatherFrom(const Model& model, NearPlaces& near, const Vector3d& p, double reach) noexcept {
  return near.gather(model, p, reach);
}

}  // namespace

/// Adapts the reach of the next gathering to the number of rows that were gathered.
template <class Near>
void Search::adaptReach(const Near& near, const Vector3d& p, double distance) noexcept {
  using Limits = typename Near::Limits;
  if (near.rows() > Limits::kMany)
    reach_ *= 0.8;
  else if (near.rows() < Limits::kFew)
    reach_ = std::min(1.25 * reach_, model_.bounds().diagonal().norm());
  else
    reach_ = std::min(reach_, 1.2 * std::max(near.beyond(p) - distance, 0.0));
}

/// Gathers the rows around p again. If the probe would leave them too soon, it gathers those that this tick needs: with
/// them, a tick takes less time than with a search from the root.
template <class Near>
bool Search::gatherNear(Near& near, const Vector3d& p, double way, double distance) noexcept {
  using Limits = typename Near::Limits;
  constexpr int kMostCrowdedTicks = 100;  // ticks until it looks again whether few rows are near
  const bool lasts = reach_ >= Limits::kWorthIt * way;
  if (!lasts) {
    reach_ = reach_ > 0 ? 1.01 * reach_ : Limits::kWorthIt * way;
    if (crowded_ticks_ > 0) {
      --crowded_ticks_;
      return false;
    }
  }
  const double reach = lasts ? distance + reach_ : distance * (1 + 1e-6);
  near_planes_.forget();
  gathered_now_ = true;
  const bool gathered = gatherFrom(model_, near, p, reach);
  if (!lasts) {
    const bool crowded = !gathered || near.rows() > Limits::kMany;
    crowded_wait_ = crowded ? std::min(2 * crowded_wait_ + 1, kMostCrowdedTicks) : 0;
    crowded_ticks_ = crowded_wait_;
  } else if (!gathered) {
    reach_ *= 0.5;
  } else {
    adaptReach(near, p, distance);
  }
  return gathered;
}

/// Examines the rows of one placement around the probe, the nearest one first.
template <class Near>
void Search::examineRows(Near& near, std::uint32_t place, const Vector3d& p, Run& run) noexcept {
  const BodyTree& body = model_.body(model_.placements()[place].body);
  const Element first = run.first_place == place ? run.first : Element();
  const auto examineRow = [&](int four, int lane, double bound) {
    const ElementRow row = near.row(four, lane);
    double known = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = row.first; i < row.first + row.count; ++i)
      known = std::min(known,
                       body.elements[i] == first ? run.first_least2 : examine(place, body.elements[i], p, bound, run));
    near.learn(four, lane, known);
  };
  RowBounds<Near> bounds(near, BoxProbe(body.tree, p));
  run.best.nodes += near.fours();
  if (const int at = bounds.takeNearest(); bounds.taken() <= run.within2())
    examineRow(at / 4, at % 4, bounds.taken());
  else
    run.others2 = std::min(run.others2, bounds.taken());
  for (int k = 0; k < near.fours(); ++k) {
    if (!bounds.anyWithin(k, run.within2())) continue;
    for (int lane = 0; lane < 4; ++lane)
      if (const double bound = bounds.at(k, lane); bound <= run.within2()) {
        examineRow(k, lane, bound);
        bounds.take(k, lane);
      }
  }
  run.others2 = std::min(run.others2, bounds.least());
}

template <>
void Search::examineRows(NearTriangles& near, std::uint32_t place, const Vector3d& p, Run& run) noexcept;

template <class Near>
void Search::examineAll(Near& near, const Vector3d& p, Run& run) noexcept {
  examineRows(near, 0, p, run);
}

/// The placement of the last point is examined first, because the nearest point is most likely there.
template <>
void Search::examineAll(NearPlaces& near, const Vector3d& p, Run& run) noexcept {
  for (const bool again : {false, true})
    for (int i = 0; i < near.count(); ++i)
      if (const std::uint32_t place = near[i].place; (place == last_.place) != again)
        examineRows(near[i].elements, place, model_.placements()[place].toBody(p), run);
}

/// Examines the gathered rows. Returns false if another element may be nearer, or equally near.
template <class Near>
bool Search::examineNear(Near& near, const Vector3d& p, Run& run) noexcept {
  examineAll(near, p, run);
  const double beyond = near.beyond(p);
  if (run.tied || run.restarts <= 0 || !(run.best.hit.d2 <= run.limit2)) return false;
  if (!(std::sqrt(run.best.hit.d2) * (1 + kRounding) < beyond)) return false;
  run.others2 = std::min(run.others2, beyond * beyond);
  return true;
}

template <class Near>
bool Search::searchNear(Near& near, const Vector3d& p, double way, Run& run) noexcept {
  const Run start = run;
  if (last_.distance() < near.beyond(p)) {
    if (examineNear(near, p, run)) return true;
    run = start;
  }
  if (gatherNear(near, p, way, std::sqrt(run.within2())) && examineNear(near, p, run)) return true;
  run = start;
  return false;
}

/// Searches only the rows around the probe. Returns true if the result is the same as from a search of the whole model.
bool Search::searchNear(const Vector3d& p_model, double way, Run& run) noexcept {
  if (!last_.found() || last_.exhausted || !(run.within2() < kFarthestNear2)) return false;
  if (model_.placements().size() > 1)
    return whole_nodes_ >= NearPlaces::kFewestNodes && run.budget.elements > NearPlaces::kMostRows &&
           searchNear(near_places_, p_model, way, run);
  const Placement& place = model_.placements()[0];
  const Vector3d p = place.toBody(p_model);
  if (model_.body(place.body).discs.empty())
    return run.budget.elements > NearElements::kMostRows && searchNear(near_elements_, p, way, run);
  return run.budget.elements > NearTriangles::kMostRows * BodyTree::kMeshRow &&
         searchNear(near_triangles_, p, way, run);
}

/// Tells the gathered rows that the probe has moved by `way` [m], or forgets them if the last search found nothing.
void Search::moveNear(double way) noexcept {
  way_ = way;
  gathered_now_ = false;
  if (last_.found()) {
    near_elements_.probeMoved(way);
    near_triangles_.probeMoved(way);
    near_places_.probeMoved(way);
  } else {
    near_elements_.forget();
    near_triangles_.forget();
    near_planes_.forget();
    near_places_.forget();
  }
}

}  // namespace hapticd::brep
