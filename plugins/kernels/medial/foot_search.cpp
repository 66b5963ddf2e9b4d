// SPDX-License-Identifier: MIT
/// Two searches for the foot on a skeleton: Newton's method from a known start, and nested bisection.
#include <algorithm>
#include <cmath>

#include "kernels/medial/bounds.hpp"
#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// least curvature of a Hessian relative to the metric; with less, a step would go too far
constexpr double kLeastCurvature = 0.05;
/// [m] a query that is nearer to the skeleton than this lies on it, and d has no direction
constexpr double kOnSkeleton = 1e-9;
/// [m] If a query is nearer to the skeleton than this, the remaining error of the search shows in the direction of d.
constexpr double kNearSkeleton = 1e-6;
constexpr double kRemainders = 10;  ///< the same limit as a multiple of the remaining Newton step
/// share of the trace that is added to the diagonal, so that a collapsed direction stays solvable
constexpr double kSingular = 1e-14;

using Box = std::array<std::array<double, 2>, 2>;

/// The results of one evaluation.
struct State {
  spline::SurfacePoint s;
  ScalarField::Value r;
  Vector3d d;           ///< vector from the skeleton to the query
  double distance = 0;  ///< [m] length of d
  double value = 0;     ///< the quantity that is minimised at the foot
};

/// One search: the function that it minimises, and the box of parameters.
class Search {
 public:
  Search(const Skeleton& skeleton, const Vector3d& p, Envelope envelope)
      : skeleton_(skeleton), p_(p), exact_(envelope == Envelope::kExact && !skeleton.radius().constant()) {
    for (std::size_t a = 0; a < 2; ++a) box_[a] = {skeleton.parameters()[a].front(), skeleton.parameters()[a].back()};
  }

  void evaluate(const Vector2d& x, State& q) noexcept {
    skeleton_.surface().evaluate2(x[0], x[1], q.s);
    q.r = skeleton_.radius().evaluate2(x[0], x[1]);
    q.d = p_ - q.s.S;
    q.distance = q.d.norm();
    q.value = q.distance - (exact_ ? q.r.f : 0);
    ++evaluations_;
  }

  Vector2d inside(const Vector2d& x) const noexcept {
    return {std::clamp(x[0], box_[0][0], box_[0][1]), std::clamp(x[1], box_[1][0], box_[1][1])};
  }

  /// Returns x, moved to the boundary if that is nearer than `share` of the range.
  Vector2d toRim(Vector2d x, double share) const noexcept {
    for (std::size_t a = skeleton_.curve() ? 1 : 0; a < 2; ++a) {
      double& at = x[static_cast<Eigen::Index>(a)];
      const double width = share * (box_[a][1] - box_[a][0]);
      if (at - box_[a][0] <= width) at = box_[a][0];
      if (box_[a][1] - at <= width) at = box_[a][1];
    }
    return x;
  }

  /// Returns the step from x to the foot, to second order, limited to the box.
  Vector2d step(const State& q, const Vector2d& x) const noexcept;
  /// Returns minus the derivative of the value along one parameter, times |d|; `height` is used for |d|.
  double slope(const State& q, std::size_t axis, double height) const noexcept {
    const Vector3d& tangent = axis == 0 ? q.s.Su : q.s.Sv;
    return q.d.dot(tangent) + (exact_ ? height * (axis == 0 ? q.r.fu : q.r.fv) : 0);
  }
  /// Makes a last, short step to first order without an evaluation. The remaining error is of the order of its square.
  void follow(const Vector2d& move, Vector2d& x, State& q) const noexcept {
    x += move;
    q.s.S += q.s.Su * move[0] + q.s.Sv * move[1];
    q.r.f = std::max(0.0, q.r.f + q.r.fu * move[0] + q.r.fv * move[1]);
    q.d = p_ - q.s.S;
    q.distance = q.d.norm();
  }
  void finish(const State& q, const Vector2d& x, SkeletonFoot& foot) const noexcept;

  const Box& box() const noexcept { return box_; }
  int evaluations() const noexcept { return evaluations_; }

 private:
  Matrix2d hessian(const State& q, double height, bool flat, const std::array<bool, 2>& held) const noexcept;
  double planeHeight(const State& q, const Matrix2d& metric) const noexcept;
  Vector3d radiusGradient(const State& q) const noexcept;
  Vector3d ownNormal(const State& q, const Vector3d& across, const Vector3d& gradient) const noexcept;
  Vector2d solve(const Matrix2d& h, const Vector2d& g, const std::array<bool, 2>& held,
                 const Vector2d& x) const noexcept;

  const Skeleton& skeleton_;
  const Vector3d& p_;
  /// true if the radius counts. If all radii are equal it is false, because |d| alone has the same foot, and its square
  /// is smooth on the skeleton
  bool exact_;
  Box box_;
  int evaluations_ = 0;
};

Matrix2d metricOf(const State& q) noexcept {
  Matrix2d metric;
  metric << q.s.Su.dot(q.s.Su), q.s.Su.dot(q.s.Sv), q.s.Su.dot(q.s.Sv), q.s.Sv.dot(q.s.Sv);
  return metric;
}

/// Shifts a Hessian so that it is positive in every direction that is not held: its least curvature relative to the
/// metric, if negative, changes its sign.
void makeConvex(Matrix2d& h, const Matrix2d& metric, const std::array<bool, 2>& held) noexcept {
  double least = 0;
  if (held[0] || held[1]) {
    const Eigen::Index free = held[0] ? 1 : 0;
    least = h(free, free) / std::max(metric(free, free), 1e-300);
  } else {
    const double area2 = metric.determinant();
    if (!(area2 > 0)) {
      h = metric;
      return;
    }
    const double mean = 0.5 * (h(0, 0) * metric(1, 1) + h(1, 1) * metric(0, 0) - 2 * h(0, 1) * metric(0, 1)) / area2;
    least = mean - std::sqrt(std::max(0.0, mean * mean - h.determinant() / area2));
  }
  if (!(least > kLeastCurvature)) h += (std::max(-least, kLeastCurvature) - least) * metric;
}

/// Returns |d| times the Hessian of |d| - r, made convex if it is not.
/// @param flat true if |d| comes from the tangent plane and does not vary to first order
Matrix2d Search::hessian(const State& q, double height, bool flat, const std::array<bool, 2>& held) const noexcept {
  const Matrix2d metric = metricOf(q);
  Matrix2d h = metric;
  h(0, 0) -= q.d.dot(q.s.Suu);
  h(0, 1) -= q.d.dot(q.s.Suv);
  h(1, 1) -= q.d.dot(q.s.Svv);
  if (exact_) {
    h(0, 0) -= height * q.r.fuu;
    h(0, 1) -= height * q.r.fuv;
    h(1, 1) -= height * q.r.fvv;
    if (!flat && q.distance > 0) {
      const Vector2d along(q.s.Su.dot(q.d) / q.distance, q.s.Sv.dot(q.d) / q.distance);
      h(0, 0) -= along[0] * along[0];
      h(0, 1) -= along[0] * along[1];
      h(1, 1) -= along[1] * along[1];
    }
  }
  h(1, 0) = h(0, 1);
  makeConvex(h, metric, held);
  return h;
}

/// Returns |d| at the foot if the skeleton is replaced by its tangent plane; it is valid also if the query lies on the
/// skeleton.
double Search::planeHeight(const State& q, const Matrix2d& metric) const noexcept {
  const Vector3d cross = q.s.Su.cross(q.s.Sv);
  const double area2 = cross.squaredNorm();
  if (skeleton_.curve() || !(area2 > 0)) {
    const double length2 = metric(1, 1);
    if (!(length2 > 0)) return q.distance;
    const double along = q.d.dot(q.s.Sv),
                 steep2 = std::min(q.r.fv * q.r.fv / length2, kSteepestRadius * kSteepestRadius);
    return std::sqrt(std::max(0.0, q.distance * q.distance - along * along / length2) / (1 - steep2));
  }
  const Vector2d slope(q.r.fu, q.r.fv);
  const double steep2 = slope.dot(Vector2d(metric(1, 1) * slope[0] - metric(0, 1) * slope[1],
                                           metric(0, 0) * slope[1] - metric(0, 1) * slope[0])) /
                        area2;
  return std::fabs(q.d.dot(cross)) / std::sqrt(area2 * (1 - std::min(steep2, kSteepestRadius * kSteepestRadius)));
}

/// Solves for the parameters that are not held. If the solution leaves the box, it solves again with these parameters
/// held at the boundary.
Vector2d Search::solve(const Matrix2d& h, const Vector2d& g, const std::array<bool, 2>& held,
                       const Vector2d& x) const noexcept {
  const double small = kSingular * (h(0, 0) + h(1, 1)) + 1e-300;
  const double a = h(0, 0) + small, b = h(1, 1) + small;
  if (held[0] && held[1]) return Vector2d::Zero();
  if (held[0]) return inside(x + Vector2d(0, g[1] / b)) - x;
  if (held[1]) return inside(x + Vector2d(g[0] / a, 0)) - x;
  const double det = a * b - h(0, 1) * h(0, 1);
  Vector2d move = Vector2d(b * g[0] - h(0, 1) * g[1], a * g[1] - h(0, 1) * g[0]) / std::max(det, 1e-300);
  const Vector2d kept = inside(x + move) - x;
  if (kept == move) return move;
  const bool first = std::fabs(kept[0] - move[0]) * std::sqrt(a) > std::fabs(kept[1] - move[1]) * std::sqrt(b);
  move = first ? Vector2d(kept[0], (g[1] - h(0, 1) * kept[0]) / b) : Vector2d((g[0] - h(0, 1) * kept[1]) / a, kept[1]);
  return inside(x + move) - x;
}

Vector2d Search::step(const State& q, const Vector2d& x) const noexcept {
  std::array<bool, 2> held{skeleton_.curve(), false};
  bool rim = false;
  for (std::size_t a = skeleton_.curve() ? 1 : 0; a < 2; ++a) {
    const double g = slope(q, a, q.distance), at = x[static_cast<Eigen::Index>(a)];
    held[a] = (at <= box_[a][0] && g < 0) || (at >= box_[a][1] && g > 0);
    rim |= held[a];
  }
  const auto moveFor = [&](double height, bool flat) {
    return solve(hessian(q, height, flat, held), {slope(q, 0, height), slope(q, 1, height)}, held, x);
  };
  const Vector2d move = moveFor(q.distance, false);
  const double length = (q.s.Su * move[0] + q.s.Sv * move[1]).norm();
  if (!exact_ || rim || 2 * length < q.distance) return move;
  return moveFor(planeHeight(q, metricOf(q)), true);  // the kink of |d| at the skeleton is within reach of the step
}

/// Returns the gradient of the radius along the skeleton, at most kSteepestRadius long.
Vector3d Search::radiusGradient(const State& q) const noexcept {
  if (!exact_) return Vector3d::Zero();
  Vector3d gradient = Vector3d::Zero();
  const Matrix2d metric = metricOf(q);
  if (const double area2 = metric.determinant(); !skeleton_.curve() && area2 > 0) {
    gradient = ((metric(1, 1) * q.r.fu - metric(0, 1) * q.r.fv) * q.s.Su +
                (metric(0, 0) * q.r.fv - metric(0, 1) * q.r.fu) * q.s.Sv) /
               area2;
  } else if (metric(1, 1) > 0) {
    gradient = q.r.fv / metric(1, 1) * q.s.Sv;
  }
  const double steep = gradient.norm();
  return steep > kSteepestRadius ? Vector3d(kSteepestRadius / steep * gradient) : gradient;
}

/// Returns the direction of d at a foot in the interior of the skeleton. It comes from the condition of the foot; d
/// itself only gives the side.
Vector3d Search::ownNormal(const State& q, const Vector3d& across, const Vector3d& gradient) const noexcept {
  Vector3d side = Vector3d::Zero();
  if (!skeleton_.curve() && !across.isZero(0)) {
    side = q.d.dot(across) < 0 ? Vector3d(-across) : across;
  } else if (const double length2 = q.s.Sv.squaredNorm(); length2 > 0) {
    side = q.d - q.d.dot(q.s.Sv) / length2 * q.s.Sv;
    side = side.norm() > kOnSkeleton ? side.normalized() : q.s.Sv.unitOrthogonal();
  } else {
    return Vector3d::UnitX();
  }
  return std::sqrt(1 - gradient.squaredNorm()) * side - gradient;
}

void Search::finish(const State& q, const Vector2d& x, SkeletonFoot& foot) const noexcept {
  foot.u = x[0];
  foot.v = x[1];
  foot.center = q.s.S;
  foot.radius = q.r.f;
  foot.depth = q.r.f - q.distance;
  foot.evaluations = evaluations_;
  const std::size_t first = skeleton_.curve() ? 1 : 0;
  for (std::size_t a = first; a < 2; ++a) {
    const double at = x[static_cast<Eigen::Index>(a)];
    foot.rim |= at <= box_[a][0] || at >= box_[a][1];
  }
  const Vector3d cross = q.s.Su.cross(q.s.Sv);
  const double area = cross.norm();
  if (area > 0) foot.across = cross / area;
  const Vector3d gradient = radiusGradient(q);
  foot.slope = gradient.norm();
  const double near = foot.rim ? kOnSkeleton : std::max(kNearSkeleton, kRemainders * foot.residual);
  foot.normal = q.distance > near ? Vector3d(q.d / q.distance) : ownNormal(q, foot.across, gradient);
}

}  // namespace

SkeletonFoot Skeleton::nearest(const Vector3d& p, double u, double v, const NewtonOptions& options) const noexcept {
  SkeletonFoot foot;
  if (!p.allFinite() || !std::isfinite(u) || !std::isfinite(v)) return foot;
  Search search(*this, p, options.envelope);
  Vector2d x = search.inside({u, v});
  std::array<State, 2> states;  // the current state, and the one that is being tried; they change places
  std::size_t now = 0;
  search.evaluate(x, states[now]);
  Vector2d move = search.step(states[now], x);
  while (true) {
    const State& q = states[now];
    foot.residual = (q.s.Su * move[0] + q.s.Sv * move[1]).norm();
    foot.converged = foot.residual < options.tolerance;
    if (foot.converged || search.evaluations() >= options.max_evaluations) break;
    State& next = states[1 - now];
    next.s.span = q.s.span;
    search.evaluate(x + move, next);
    if (next.value <= q.value + 1e-15) {
      x += move;
      now = 1 - now;
      move = search.step(states[now], x);
    } else {
      move *= 0.5;
    }
  }
  if (foot.converged) search.follow(move, x, states[now]);
  search.finish(states[now], x, foot);
  return foot;
}

SkeletonFoot Skeleton::bisect(const Vector3d& p, Envelope envelope, int halvings) const noexcept {
  SkeletonFoot foot;
  if (!p.allFinite()) return foot;
  Search search(*this, p, envelope);
  State q;
  Vector2d x(search.box()[0][0], search.box()[1][0]);
  search.evaluate(x, q);
  const auto halve = [&](std::size_t axis, const auto& refine) {
    std::array<double, 2> range = search.box()[axis];
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (range[0] + range[1]);
      x[static_cast<Eigen::Index>(axis)] = middle;
      refine();
      range[search.slope(q, axis, q.distance) > 0 ? 0 : 1] = middle;
    }
  };
  const auto rows = [&] { halve(1, [&] { search.evaluate(x, q); }); };
  if (curve_) {
    rows();
  } else {
    halve(0, rows);
  }
  foot.residual = (q.s.Su.norm() * (search.box()[0][1] - search.box()[0][0]) +
                   q.s.Sv.norm() * (search.box()[1][1] - search.box()[1][0])) *
                  std::ldexp(1.0, -halvings);
  // bisection alone never ends exactly on the rim
  search.follow(search.toRim(x, std::ldexp(1.0, -halvings)) - x, x, q);
  search.finish(q, x, foot);
  foot.converged = true;
  return foot;
}

}  // namespace hapticd::medial
