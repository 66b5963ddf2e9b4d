#include "kernels/medial/skeleton.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernels/spline/interpolation.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSamplesPerInterval = 3;  ///< of a cold search, each way
constexpr int kColdStarts = 4;          ///< samples that Newton starts from in a cold search
constexpr int kColdEvaluations = 40;
constexpr double kStepTolerance = 1e-9;  ///< [m] a shorter step is no news to a hand
constexpr double kSteepest = 0.99;       ///< slope of the radius beyond which spheres are nested

/// All that one evaluation gives.
struct State {
  spline::SurfacePoint s;
  ScalarField::Value r;
  Vector3d d;       ///< from the skeleton to the query
  double distance;  ///< |d|
  double value;     ///< what is least at the foot
};

/// The Newton step of least |d| - r (or |d|): H x = J^T d + grad r E, where E is the distance |d| has at the foot. E is
/// taken from the tangent plane, so that the step stays finite where the query lies on the skeleton itself.
Vector2d step(const State& q, bool exact, const Vector2d& at, const std::array<std::array<double, 2>, 2>& box) {
  Eigen::Matrix2d metric;
  metric << q.s.Su.dot(q.s.Su), q.s.Su.dot(q.s.Sv), q.s.Su.dot(q.s.Sv), q.s.Sv.dot(q.s.Sv);
  Vector2d gradient(q.d.dot(q.s.Su), q.d.dot(q.s.Sv));
  if (exact) {
    const Vector2d slope(q.r.fu, q.r.fv);
    const Vector3d cross = q.s.Su.cross(q.s.Sv);
    const double area2 = cross.squaredNorm();
    const double steep2 = area2 > 0 ? slope.dot(Vector2d(metric(1, 1) * slope[0] - metric(0, 1) * slope[1],
                                                         metric(0, 0) * slope[1] - metric(0, 1) * slope[0])) /
                                          area2
                                    : 0;
    const bool rim = at[0] <= box[0][0] || at[0] >= box[0][1] || at[1] <= box[1][0] || at[1] >= box[1][1];
    // On the rim the foot need not be stationary across it: only |d| itself gives the right slope along the rim.
    const bool plane = area2 > 0 && !rim;
    const double height =
        plane ? std::fabs(q.d.dot(cross)) / std::sqrt(area2 * (1 - std::min(steep2, kSteepest * kSteepest)))
              : q.distance;
    gradient += slope * height;
  }
  Eigen::Matrix2d h = metric;
  h(0, 0) -= q.d.dot(q.s.Suu);
  h(0, 1) -= q.d.dot(q.s.Suv);
  h(1, 0) = h(0, 1);
  h(1, 1) -= q.d.dot(q.s.Svv);
  if (!(h(0, 0) > 0 && h.determinant() > 1e-6 * metric.determinant())) h = metric;
  std::array<bool, 2> held{};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    held[i] = (at[e] <= box[i][0] && gradient[e] < 0) || (at[e] >= box[i][1] && gradient[e] > 0);
  }
  if (held[0] && held[1]) return Vector2d::Zero();
  if (held[0]) return {0, gradient[1] / std::max(h(1, 1), 1e-300)};
  if (held[1]) return {gradient[0] / std::max(h(0, 0), 1e-300), 0};
  const double det = std::max(h.determinant(), 1e-300);
  return Vector2d(h(1, 1) * gradient[0] - h(0, 1) * gradient[1], h(0, 0) * gradient[1] - h(0, 1) * gradient[0]) / det;
}

}  // namespace

Skeleton::Skeleton(const SkeletonGrid& grid, int degree) {
  const auto total = static_cast<std::size_t>(grid.count[0]) * static_cast<std::size_t>(grid.count[1]);
  if (grid.count[0] < 2 || grid.count[1] < 2)
    throw std::invalid_argument("skeleton: " + std::to_string(grid.count[0]) + " x " + std::to_string(grid.count[1]) +
                                " points, expected at least 2 x 2");
  if (grid.points.size() != total || grid.radius.size() != total)
    throw std::invalid_argument("skeleton: " + std::to_string(grid.points.size()) + " points and " +
                                std::to_string(grid.radius.size()) + " radii, expected " + std::to_string(total));
  Eigen::MatrixXd data(static_cast<Eigen::Index>(total), 3);
  for (std::size_t i = 0; i < total; ++i) data.row(static_cast<Eigen::Index>(i)) = grid.points[i].transpose();
  const spline::GridFit fit = spline::interpolateGrid(
      data, grid.count, {std::min(degree, grid.count[0] - 1), std::min(degree, grid.count[1] - 1)});
  spline::SurfaceData surface;
  surface.degree = fit.degree;
  surface.knots = fit.knots;
  for (Eigen::Index i = 0; i < fit.control.rows(); ++i) surface.points.emplace_back(fit.control.row(i).transpose());
  surface.name = "skeleton";
  surface_ = std::make_unique<spline::Surface>(surface);
  parameters_ = fit.parameters;
  radius_ = ScalarField(parameters_, grid.radius);
  sample();
}

void Skeleton::sample() {
  std::array<std::vector<double>, 2> at;
  for (std::size_t a = 0; a < 2; ++a) {
    for (std::size_t i = 0; i + 1 < parameters_[a].size(); ++i)
      for (int k = 0; k < kSamplesPerInterval; ++k)
        at[a].push_back(parameters_[a][i] + (parameters_[a][i + 1] - parameters_[a][i]) * k / kSamplesPerInterval);
    at[a].push_back(parameters_[a].back());
  }
  for (const double u : at[0]) {
    for (const double v : at[1]) {
      spline::SurfacePoint s;
      surface_->evaluate1(u, v, s);
      samples_.push_back({s.S, radius_.evaluate(u, v).f, u, v});
    }
  }
}

SkeletonFoot Skeleton::nearest(const Vector3d& p, double u, double v, Envelope envelope,
                               int max_evaluations) const noexcept {
  const bool exact = envelope == Envelope::kExact;
  const std::array<std::array<double, 2>, 2> box{
      {{parameters_[0].front(), parameters_[0].back()}, {parameters_[1].front(), parameters_[1].back()}}};
  const auto inside = [&](const Vector2d& x) {
    return Vector2d(std::clamp(x[0], box[0][0], box[0][1]), std::clamp(x[1], box[1][0], box[1][1]));
  };
  SkeletonFoot foot;
  const auto evaluate = [&](const Vector2d& x) {
    State q;
    surface_->evaluate2(x[0], x[1], q.s);
    q.r = radius_.evaluate(x[0], x[1]);
    q.d = p - q.s.S;
    q.distance = q.d.norm();
    q.value = q.distance - (exact ? q.r.f : 0);
    ++foot.evaluations;
    return q;
  };
  if (!p.allFinite() || !std::isfinite(u) || !std::isfinite(v)) return foot;
  Vector2d x = inside({u, v});
  State q = evaluate(x);
  Vector2d move = inside(x + step(q, exact, x, box)) - x;
  while (true) {
    foot.converged = (q.s.Su * move[0] + q.s.Sv * move[1]).norm() < kStepTolerance;
    if (foot.converged || foot.evaluations >= max_evaluations) break;
    const State next = evaluate(x + move);
    if (next.value <= q.value + 1e-15) {
      x += move;
      q = next;
      move = inside(x + step(q, exact, x, box)) - x;
    } else {
      move *= 0.5;
    }
  }
  foot.u = x[0];
  foot.v = x[1];
  foot.center = q.s.S;
  foot.radius = q.r.f;
  foot.depth = q.r.f - q.distance;
  const Vector3d cross = q.s.Su.cross(q.s.Sv);
  if (q.distance > 0)
    foot.normal = q.d / q.distance;
  else if (cross.squaredNorm() > 0)
    foot.normal = cross.normalized();
  return foot;
}

SkeletonFoot Skeleton::search(const Vector3d& p, Envelope envelope) const noexcept {
  struct Start {
    double value = HUGE_VAL;
    const Sample* sample = nullptr;
  };
  std::array<Start, kColdStarts> starts;
  for (const Sample& s : samples_) {
    Start start{(p - s.center).norm() - (envelope == Envelope::kExact ? s.radius : 0), &s};
    for (Start& kept : starts)
      if (start.value < kept.value) std::swap(start, kept);
  }
  SkeletonFoot best;
  double least = HUGE_VAL;
  for (const Start& start : starts) {
    if (start.sample == nullptr) continue;
    const SkeletonFoot foot = nearest(p, start.sample->u, start.sample->v, envelope, kColdEvaluations);
    const double value = envelope == Envelope::kExact ? -foot.depth : (p - foot.center).norm();
    if (value < least) best = foot;
    least = std::min(least, value);
  }
  return best;
}

}  // namespace hapticd::medial
