// SPDX-License-Identifier: MIT
#include "kernels/brep/elements/newton_feet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hapticd::brep {
namespace {

using Eigen::Array2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using spline::CurvePoint;
using spline::SurfacePoint;

constexpr int kMostSteps = 16;
/// [m] A Newton step shorter than this ends the search. The remaining error is the square of the step times the
/// curvature, which is negligible.
constexpr double kShortStep = 1e-8;
/// If the determinant of the Hessian is below this share of the product of its diagonal, the quadratic model is not
/// convex enough, and the first-order (Gauss-Newton) step is used instead.
constexpr double kFlattest = 1e-5;

/// Returns the parameter just below the upper end of a piece. The derivatives at the end itself are those of what comes
/// next, which differ at a kink.
template <class Parameter>
Parameter justBelow(const Parameter& lo, const Parameter& hi) noexcept {
  using std::abs;
  constexpr double kUlp = 2.3e-16;
  return hi - kUlp * (abs(hi) + (hi - lo));
}

/// The squared distance to the probe and its derivatives at one point of a leaf.
struct LeafState {
  Array2d uv;
  SurfacePoint E;
  Vector3d r;  ///< S - p
  double f;    ///< |r|^2
};

/// One search for a foot on a leaf.
struct LeafTask {
  const Geometry& geometry;
  const Leaf& leaf;
  /// Index of the surface; for an offset its basis, because the foot there has the same parameters.
  std::uint32_t surface;
  const Vector3d& p;
  int evaluations = 0;
  bool arrived = true;  ///< true if the last descent ended at a minimum
  Array2d below = justBelow(leaf.lo, leaf.hi);

  void at(const Array2d& uv, LeafState& state) noexcept {
    state.uv = uv;
    geometry.surface(surface, std::min(uv[0], below[0]), std::min(uv[1], below[1]), state.E);
    state.r = state.E.S - p;
    state.f = state.r.squaredNorm();
    ++evaluations;
  }
};

/// Returns the step to the foot of the quadratic model. If the point is pressed against a side of the leaf, the step
/// runs along that side.
Vector2d stepFrom(const LeafTask& task, const LeafState& s) noexcept {
  const SurfacePoint& E = s.E;
  const Vector2d g(s.r.dot(E.Su), s.r.dot(E.Sv));
  const double g00 = E.Su.squaredNorm(), g11 = E.Sv.squaredNorm(), g01 = E.Su.dot(E.Sv);
  double h00 = g00 + s.r.dot(E.Suu), h11 = g11 + s.r.dot(E.Svv), h01 = g01 + s.r.dot(E.Suv);
  if (!(h00 > kFlattest * g00)) h00 = g00;
  if (!(h11 > kFlattest * g11)) h11 = g11;
  const bool held0 = (s.uv[0] <= task.leaf.lo[0] && g[0] > 0) || (s.uv[0] >= task.leaf.hi[0] && g[0] < 0) || !(g00 > 0);
  const bool held1 = (s.uv[1] <= task.leaf.lo[1] && g[1] > 0) || (s.uv[1] >= task.leaf.hi[1] && g[1] < 0) || !(g11 > 0);
  if (held0 || held1) return {held0 ? 0 : -g[0] / h00, held1 ? 0 : -g[1] / h11};
  double det = h00 * h11 - h01 * h01;
  if (!(det > kFlattest * h00 * h11)) {  // the quadratic model has no minimum, but the first-order step descends
    h00 = g00 * (1 + 1e-9);
    h11 = g11 * (1 + 1e-9);
    h01 = g01;
    det = h00 * h11 - h01 * h01;
  }
  return {(h01 * g[1] - h11 * g[0]) / det, (h01 * g[0] - h00 * g[1]) / det};
}

/// Runs Newton's method from s on; the distance never grows. Returns the last short step, which the caller must add.
Vector2d descend(LeafTask& task, LeafState& s) noexcept {
  // relative to the distance; rounding of the squared distance may hide the gain of a step that is shorter than this
  constexpr double kStuck = 1e-7;
  Vector2d d = stepFrom(task, s);
  LeafState trial;
  task.arrived = false;
  for (int i = 0; i < kMostSteps; ++i) {
    Array2d target = (s.uv + d.array()).max(task.leaf.lo).min(task.leaf.hi);
    d = (target - s.uv).matrix();
    const double step2 = (s.E.Su * d[0] + s.E.Sv * d[1]).squaredNorm();
    task.arrived = step2 <= kShortStep * kShortStep + kStuck * kStuck * s.f;
    if (step2 <= kShortStep * kShortStep) break;
    trial.E.span = s.E.span;
    task.at(target, trial);
    for (int halvings = 0; !(trial.f <= s.f) && halvings < 6; ++halvings) {
      d *= 0.3;
      task.at(s.uv + d.array(), trial);
    }
    if (!(trial.f <= s.f)) return {0, 0};
    std::swap(s, trial);
    d = stepFrom(task, s);
  }
  return ((s.uv + d.array()).max(task.leaf.lo).min(task.leaf.hi) - s.uv).matrix();
}

/// True if the foot lies at a border where the surface ends, and the distance would still fall beyond that border.
bool pressesOutward(const Leaf& leaf, const LeafState& s, const Array2d& uv) noexcept {
  constexpr double kStationary = 1e-9;  // cosine between the direction to the probe and the tangent
  for (int axis = 0; axis < 2; ++axis) {
    const Vector3d& tangent = axis == 0 ? s.E.Su : s.E.Sv;
    const double cosine = s.r.dot(tangent), enough = kStationary * std::sqrt(s.f) * tangent.norm();
    const auto low = 1u << (2 * axis), high = 2u << (2 * axis);
    if ((leaf.borders & low) != 0 && uv[axis] <= leaf.lo[axis] && cosine > enough) return true;
    if ((leaf.borders & high) != 0 && uv[axis] >= leaf.hi[axis] && cosine < -enough) return true;
  }
  return false;
}

/// Replaces `hit` by the foot after the last step from s, if this foot is nearer. Returns its squared distance, or
/// infinity if it is outside the trim or refused. `untrimmed2` is lowered to its squared distance in any case.
double take(const LeafTask& task, const FaceShape& face, const LeafState& s, const Vector2d& d, double offset,
            double& untrimmed2, Hit& hit) noexcept {
  const Array2d uv = (s.uv + d.array()).max(task.leaf.lo).min(task.leaf.hi);
  Vector3d point = s.E.S + d[0] * s.E.Su + d[1] * s.E.Sv +
                   0.5 * (d[0] * d[0] * s.E.Suu + 2 * d[0] * d[1] * s.E.Suv + d[1] * d[1] * s.E.Svv);
  if (offset != 0) {
    const Vector3d Su = s.E.Su + d[0] * s.E.Suu + d[1] * s.E.Suv, Sv = s.E.Sv + d[0] * s.E.Suv + d[1] * s.E.Svv;
    point += offset * Su.cross(Sv).normalized();
  }
  const double d2 = (point - task.p).squaredNorm();
  untrimmed2 = std::min(untrimmed2, d2);
  if (pressesOutward(task.leaf, s, uv) || !face.trim.inside(uv[0], uv[1]))
    return std::numeric_limits<double>::infinity();
  if (!(d2 < hit.d2)) return d2;
  hit.d2 = d2;
  hit.point = point;
  hit.u = uv[0];
  hit.v = uv[1];
  return d2;
}

/// True if the probe is nearer to its foot than every centre of curvature of the leaf on the probe's side. Where a
/// tangent vanishes, the side is not known, and both count.
bool isWithinFocus(const Leaf& leaf, const FaceShape& face, const LeafState& s, double offset) noexcept {
  const double side = -face.outward * s.r.dot(s.E.Su.cross(s.E.Sv));
  const auto front = static_cast<double>(leaf.curvature_front.value()),
             back = static_cast<double>(leaf.curvature_back.value());
  return (std::sqrt(s.f) + offset) * (side == 0 ? std::max(front, back) : side > 0 ? front : back) < 1;
}

/// True if a tangent vanishes (at a pole, or where control points coincide). Newton's method takes such a point for a
/// foot wherever the probe is, because every slope along that tangent is 0.
bool isSingular(const Leaf& leaf, const LeafState& s) noexcept {
  const Array2d size2 = (leaf.hi - leaf.lo).square();
  constexpr double kShort2 = kShortStep * kShortStep;
  return s.E.Su.squaredNorm() * size2[0] <= kShort2 || s.E.Sv.squaredNorm() * size2[1] <= kShort2;
}

/// Returns a lower bound of the squared distance to a leaf on which the probe has one foot. It follows from the slope
/// at s and `least_second`, the least second derivative. A slope that rises inward from a border of the leaf is left
/// out, because the distance can only grow along it.
double lowerBoundFrom(const LeafTask& task, const LeafState& s, double least_second) noexcept {
  Vector2d slope(s.r.dot(s.E.Su), s.r.dot(s.E.Sv));
  for (int axis = 0; axis < 2; ++axis)
    if ((s.uv[axis] <= task.leaf.lo[axis] && slope[axis] > 0) || (s.uv[axis] >= task.leaf.hi[axis] && slope[axis] < 0))
      slope[axis] = 0;
  double square = 0;
  for (int i = 0; i < 2; ++i) {
    const Array2d along = task.leaf.curvature.along(i);
    const double one = along[0] * slope[0] + along[1] * slope[1];
    square += one * one;
  }
  return s.f * (1 - 1e-9) - square * (1 + 1e-9) / least_second;
}

}  // namespace

NewtonResult leafFoot(const Geometry& geometry, const Leaf& leaf, const FaceShape& face, std::uint32_t surface,
                      const Vector3d& p, const LeafStart& start, Hit& hit) noexcept {
  const Surface& shape = geometry.part().surfaces[surface];
  const bool is_offset = shape.kind == SurfaceKind::kOffset;
  const double offset = is_offset ? shape.r[0] : 0;
  LeafTask task{geometry, leaf, is_offset ? shape.basis : surface, p};
  LeafState s;
  task.at(start.uv.max(leaf.lo).min(leaf.hi), s);
  NewtonResult answer;
  if (start.feet.least_second > 0 && s.f > start.limit2)
    if (const double least = lowerBoundFrom(task, s, start.feet.least_second); least > start.limit2) {
      answer.d2 = answer.untrimmed2 = least;
      answer.evaluations = task.evaluations;
      return answer;
    }
  Vector2d d = descend(task, s);
  answer.d2 = take(task, face, s, d, offset, answer.untrimmed2, hit);
  answer.proved =
      task.arrived && (start.feet.number != FeetOfLeaf::kUnknown || isWithinFocus(leaf, face, s, std::abs(offset)));
  const bool again = !answer.proved || isSingular(leaf, s);
  answer.proved = answer.proved && (!again || start.elsewhere);
  // If the probe is beyond a centre of curvature, there may be several feet. So the search also starts near the
  // corners, and likewise if it ended where a tangent vanishes.
  for (int corner = 0; corner < 4 && again && start.elsewhere; ++corner) {
    const Array2d share(corner % 2 == 0 ? 0.1 : 0.9, corner < 2 ? 0.1 : 0.9);
    task.at(leaf.lo + share * (leaf.hi - leaf.lo), s);
    d = descend(task, s);
    answer.d2 = std::min(answer.d2, take(task, face, s, d, offset, answer.untrimmed2, hit));
    ++answer.starts;
  }
  answer.evaluations = task.evaluations;
  return answer;
}

namespace {

/// The squared distance to the probe and its derivatives at one point of a curve.
struct CurveState {
  double t;
  CurvePoint C;
  Vector3d r;
  double f;
};

struct CurveTask {
  const Geometry& geometry;
  const CurvePiece& piece;
  std::uint32_t curve;
  const Vector3d& p;
  int evaluations = 0;
  double below = justBelow(piece.t0, piece.t1);

  void at(double t, CurveState& state) noexcept {
    state.t = t;
    geometry.curve(curve, std::min(t, below), state.C);
    state.r = state.C.C - p;
    state.f = state.r.squaredNorm();
    ++evaluations;
  }
  double stepFrom(const CurveState& s) const noexcept {
    const double g = s.r.dot(s.C.C1), first = s.C.C1.squaredNorm();
    double h = first + s.r.dot(s.C.C2);
    if (!(h > kFlattest * first)) h = first;
    const double step = h > 0 ? -g / h : 0;
    return std::clamp(s.t + step, piece.t0, piece.t1) - s.t;
  }
  /// True if the derivative of the curve vanishes, as it does at an end where control points coincide. Newton's method
  /// takes such a point for a foot wherever the probe is.
  bool isSingular(const CurveState& s) const noexcept { return s.C.C1.norm() * (piece.t1 - piece.t0) <= kShortStep; }
  double descend(CurveState& s) noexcept {
    double d = stepFrom(s);
    CurveState trial;
    for (int i = 0; i < kMostSteps; ++i) {
      if (d * d * s.C.C1.squaredNorm() <= kShortStep * kShortStep) break;
      trial.C.span = s.C.span;
      at(s.t + d, trial);
      for (int halvings = 0; !(trial.f <= s.f) && halvings < 6; ++halvings) {
        d *= 0.3;
        at(s.t + d, trial);
      }
      if (!(trial.f <= s.f)) return 0;
      std::swap(s, trial);
      d = stepFrom(s);
    }
    return d;
  }
};

double take(const CurveTask& task, const CurveState& s, double d, Hit& hit) noexcept {
  const Vector3d point = s.C.C + d * s.C.C1 + 0.5 * d * d * s.C.C2;
  const double d2 = (point - task.p).squaredNorm();
  if (!(d2 < hit.d2)) return d2;
  hit.d2 = d2;
  hit.point = point;
  hit.u = std::clamp(s.t + d, task.piece.t0, task.piece.t1);
  const bool first = hit.u <= task.piece.t0 && (task.piece.ends & 1u) != 0;
  const bool last = hit.u >= task.piece.t1 && (task.piece.ends & 2u) != 0;
  hit.region = static_cast<std::uint8_t>(first ? EdgeRegion::kFirst : last ? EdgeRegion::kLast : EdgeRegion::kInside);
  return d2;
}

/// Returns a lower bound of the squared distance to a piece if its second derivative is positive everywhere along the
/// piece, else 0.
double lowerBoundFrom(const CurveTask& task, const CurveState& s) noexcept {
  const double second = leastSecondDerivative(task.piece.curvature, task.p);
  const double speed2 = s.C.C1.squaredNorm(), slope = s.r.dot(s.C.C1);
  if (!(second > 0) || !(speed2 > 0)) return 0;
  if ((s.t <= task.piece.t0 && slope > 0) || (s.t >= task.piece.t1 && slope < 0)) return s.f * (1 - 1e-9);
  return s.f * (1 - 1e-9) - slope * slope * (1 + 1e-9) / (speed2 * second);
}

}  // namespace

NewtonResult pieceFoot(const Geometry& geometry, const CurvePiece& piece, const Vector3d& p, double t, double limit2,
                       Hit& hit) noexcept {
  CurveTask task{geometry, piece, geometry.part().edges[piece.edge].curve, p};
  CurveState s;
  task.at(std::clamp(t, piece.t0, piece.t1), s);
  NewtonResult answer;
  if (s.f > limit2)
    if (const double least = lowerBoundFrom(task, s); least > limit2) {
      answer.d2 = least;
      return answer;
    }
  double d = task.descend(s);
  answer.d2 = take(task, s, d, hit);
  const bool singular = task.isSingular(s);
  // If the probe is beyond a centre of curvature, there may be several feet, or only the ends may be minima.
  const FeetOfPiece feet = std::sqrt(s.f) * static_cast<double>(piece.curvature.most.value()) < 1
                               ? FeetOfPiece::kOne
                               : countFeet(piece.curvature, p);
  answer.proved = feet != FeetOfPiece::kUnknown;
  if (feet != FeetOfPiece::kOne || singular)
    for (const double share : {0.02, 0.98}) {
      task.at(piece.t0 + share * (piece.t1 - piece.t0), s);
      d = task.descend(s);
      answer.d2 = std::min(answer.d2, take(task, s, d, hit));
    }
  answer.evaluations = task.evaluations;
  return answer;
}

}  // namespace hapticd::brep
