// SPDX-License-Identifier: MIT
/// The search for the foot on a skeleton without a known start: Newton iterations from the best samples.
#include <algorithm>
#include <cmath>

#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

constexpr int kSamplesPerInterval = 3;  ///< samples per interval between points of the grid, along each direction
constexpr int kFiner = 4;               ///< factor by which samples are finer if spheres lie inside others
constexpr int kColdStarts = 8;          ///< most samples from which Newton's method starts
constexpr int kColdEvaluations = 60;

/// A sample of the skeleton from which the search may start.
struct Start {
  double value = HUGE_VAL, u = 0, v = 0;
  int row = -2, column = -2;

  bool besides(const Start& other) const noexcept {
    return std::abs(row - other.row) <= 1 && std::abs(column - other.column) <= 1;
  }
};
using Starts = std::array<Start, kColdStarts>;

/// Keeps the best samples, best first. Of two neighbouring samples it keeps only the better one. Otherwise the samples
/// of one wide valley of the distance could fill the list, and a narrow valley that is deeper would be missed.
void offer(Start start, Starts& starts) noexcept {
  std::size_t place = 0;
  while (place < starts.size() && starts[place].value <= start.value) {
    if (starts[place].besides(start)) return;
    ++place;
  }
  const Start better = start;
  for (; place < starts.size(); ++place) {
    std::swap(start, starts[place]);
    if (start.besides(better)) return;  // the worse neighbour is removed
  }
}

double sampleAt(const std::vector<double>& t, int i, int per_interval) noexcept {
  const auto cell = static_cast<std::size_t>(i / per_interval);
  if (cell + 1 >= t.size()) return t.back();
  return t[cell] + (t[cell + 1] - t[cell]) * (i % per_interval) / per_interval;
}

/// Samples of a whole skeleton for one query: `per_interval` samples in each interval of the parameters, along each
/// direction.
class Samples {
 public:
  Samples(const Skeleton& skeleton, const Vector3d& p, Envelope envelope, int per_interval)
      : skeleton_(skeleton), p_(p), exact_(envelope == Envelope::kExact), per_interval_(per_interval) {
    for (std::size_t a = skeleton.curve() ? 1 : 0; a < 2; ++a)
      last_[a] = per_interval * (static_cast<int>(skeleton.parameters()[a].size()) - 1);
  }

  void look(int i, int j, Starts& starts) const noexcept {
    if (i < 0 || j < 0 || i > last_[0] || j > last_[1]) return;
    const double u = sampleAt(skeleton_.parameters()[0], i, per_interval_);
    const double v = sampleAt(skeleton_.parameters()[1], j, per_interval_);
    spline::SurfacePoint s;
    skeleton_.surface().evaluate1(u, v, s);
    offer({(p_ - s.S).norm() - (exact_ ? skeleton_.radius().evaluate(u, v).f : 0), u, v, i, j}, starts);
  }
  Starts best() const noexcept {
    Starts starts;
    for (int i = 0; i <= last_[0]; ++i)
      for (int j = 0; j <= last_[1]; ++j) look(i, j, starts);
    return starts;
  }

 private:
  const Skeleton& skeleton_;
  const Vector3d& p_;
  bool exact_;
  int per_interval_;
  std::array<int, 2> last_{0, 0};
};

/// Returns the starts of a search. If spheres lie inside others, the distance may have several valleys between two
/// samples, so finer samples are taken about each start.
Starts coldStarts(const Skeleton& skeleton, const Vector3d& p, Envelope envelope) noexcept {
  const Starts starts = Samples(skeleton, p, envelope, kSamplesPerInterval).best();
  if (!skeleton.nested()) return starts;
  const Samples fine(skeleton, p, envelope, kFiner * kSamplesPerInterval);
  Starts finer;
  for (const Start& start : starts) {
    if (start.value == HUGE_VAL) break;
    for (int i = -kFiner; i <= kFiner; ++i)
      for (int j = -kFiner; j <= kFiner; ++j) fine.look(kFiner * start.row + i, kFiner * start.column + j, finer);
  }
  return finer;
}

}  // namespace

SkeletonFoot Skeleton::search(const Vector3d& p, const NewtonOptions& options) const noexcept {
  NewtonOptions cold = options;
  cold.max_evaluations = kColdEvaluations;
  SkeletonFoot best;
  double least = HUGE_VAL;
  int evaluations = 0;
  for (const Start& start : coldStarts(*this, p, options.envelope)) {
    if (start.value == HUGE_VAL) break;
    const SkeletonFoot foot = nearest(p, start.u, start.v, cold);
    evaluations += foot.evaluations;
    const double value = options.envelope == Envelope::kExact ? -foot.depth : (p - foot.center).norm();
    if (value < least) best = foot;
    least = std::min(least, value);
  }
  best.evaluations = evaluations;
  return best;
}

}  // namespace hapticd::medial
