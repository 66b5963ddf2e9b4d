// SPDX-License-Identifier: MIT
/// The tick of a tracked probe over a mesh: of the rows that an earlier search found about it, few need a look.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernels/brep/search.hpp"

namespace hapticd::brep {

using Eigen::Vector3d;

namespace {

constexpr float kTaken = std::numeric_limits<float>::infinity();

/// Bounds of the squared distances to the rows about a probe. What was looked at is taken out.
class RowBounds {
 public:
  RowBounds(const NearRows& rows, const BoxProbe& probe) noexcept : count_(rows.fours()) {
    for (int k = 0; k < count_; ++k) bounds_[static_cast<std::size_t>(k)] = slabDistances(rows.four(k), probe);
  }

  double at(int k, int lane) const noexcept { return static_cast<double>(bounds_[static_cast<std::size_t>(k)][lane]); }
  void take(int k, int lane) noexcept { bounds_[static_cast<std::size_t>(k)][lane] = kTaken; }
  bool anyWithin(int k, double d2) const noexcept {
    const Float4& four = bounds_[static_cast<std::size_t>(k)];
    const Float4 limit = Float4{} + static_cast<float>(d2) * (1 + 1e-6F);  // rounded up
    const auto within = four <= limit;
    return (within[0] | within[1] | within[2] | within[3]) != 0;
  }
  /// The least of what is left.
  double least() const noexcept {
    Float4 least = Float4{} + kTaken;
    for (int k = 0; k < count_; ++k) {
      const Float4& four = bounds_[static_cast<std::size_t>(k)];
      least = four < least ? four : least;
    }
    return static_cast<double>(std::min(std::min(least[0], least[1]), std::min(least[2], least[3])));
  }
  /// Takes the row with the least bound out; 4 times its four and its lane.
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
  std::array<Float4, NearRows::kMostFours> bounds_;
  int count_;
  double taken_ = 0;
};

}  // namespace

/// Gathers the rows about p again. Their number says how far to reach the next time.
bool Search::gatherNear(const Vector3d& p, double way, double distance) noexcept {
  constexpr int kFew = 16, kMany = 32;
  constexpr double kWorthIt = 4;  // ways of a tick, below which gathering costs more than it spares
  if (!(reach_ >= kWorthIt * way)) {
    reach_ = reach_ > 0 ? 1.01 * reach_ : kWorthIt * way;
    return false;
  }
  if (!near_.gather(model_.body(model_.placements()[0].body), p, distance + reach_)) {
    reach_ *= 0.5;
    return false;
  }
  if (near_.rows() > kMany) reach_ *= 0.8;
  if (near_.rows() < kFew) reach_ = std::min(1.25 * reach_, model_.bounds().diagonal().norm());
  return true;
}

/// Looks at the rows about the probe, at the nearest one first. False: something else may be nearer, or just as near.
bool Search::lookAtNear(const Vector3d& p, Run& run) noexcept {
  const BodyTree& body = model_.body(model_.placements()[0].body);
  const auto lookAtRow = [&](int four, int lane, double bound) {
    const ElementRow row = near_.row(four, lane);
    for (std::uint32_t i = row.first; i < row.first + row.count; ++i)
      if (!(body.elements[i] == run.first)) look(0, body.elements[i], p, bound, run);
  };
  RowBounds bounds(near_, BoxProbe(body.tree, p));
  run.best.nodes += near_.fours();
  if (const int at = bounds.takeNearest(); bounds.taken() <= run.best.hit.d2)
    lookAtRow(at / 4, at % 4, bounds.taken());
  else
    run.others2 = std::min(run.others2, bounds.taken());
  for (int k = 0; k < near_.fours(); ++k) {
    if (!bounds.anyWithin(k, run.best.hit.d2)) continue;
    for (int lane = 0; lane < 4; ++lane)
      if (const double bound = bounds.at(k, lane); bound <= run.best.hit.d2) {
        lookAtRow(k, lane, bound);
        bounds.take(k, lane);
      }
  }
  run.others2 = std::min(run.others2, bounds.least());
  const double beyond = near_.beyond(p);
  if (run.tied || !(std::sqrt(run.best.hit.d2) * (1 + kRounding) < beyond)) return false;
  run.others2 = std::min(run.others2, beyond * beyond);
  return true;
}

/// A search of the rows about the probe alone, which gives what one of the whole mesh would give. False: it does not.
bool Search::searchNear(const Vector3d& p_model, Run& run) noexcept {
  if (!last_.found() || last_.exhausted || run.budget.elements <= NearRows::kMostElements) return false;
  if (model_.placements().size() > 1 || model_.body(model_.placements()[0].body).slabs.empty()) return false;
  const Vector3d p = model_.placements()[0].toBody(p_model);
  const Run start = run;
  if (last_.distance() < near_.beyond(p)) {
    if (lookAtNear(p, run)) return true;
    run = start;
  }
  if (gatherNear(p, (p_model - last_p_).norm(), std::sqrt(run.best.hit.d2)) && lookAtNear(p, run)) return true;
  run = start;
  return false;
}

}  // namespace hapticd::brep
