// SPDX-License-Identifier: MIT
#include "kernels/trace/newton.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "kernels/trace/quadratic_model.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Array2d;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct Step {
  Vector2d d{0, 0};
  SideMask sides = 0;       ///< sides of the patch on which the step ends
  Vector2d straight{0, 0};  ///< d before it was bent
  bool leaves = false;      ///< the step leads away from a saddle or maximum: however short, it ends at no foot
};

double modelValue(const QuadraticModel& m, const Vector2d& d) noexcept {
  return m.g.dot(d) + 0.5 * d.dot(m.H * d);
}

/// Returns the minimum of the quadratic model in the box lo <= d <= hi. It may be inside, on one of the four sides, or
/// in a corner.
Step boxMinimum(const QuadraticModel& m, const Vector2d& lo, const Vector2d& hi) noexcept {
  const double det = m.H(0, 0) * m.H(1, 1) - m.H(0, 1) * m.H(0, 1);
  Step best;
  if (det > 0) {
    best.d = {(-m.g[0] * m.H(1, 1) + m.g[1] * m.H(0, 1)) / det, (-m.g[1] * m.H(0, 0) + m.g[0] * m.H(0, 1)) / det};
    if ((best.d.array() > lo.array()).all() && (best.d.array() < hi.array()).all()) return best;
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (int side = 0; side < kSides; ++side) {
    const int axis = Patch::axisOf(side), along = 1 - axis;
    Vector2d d;
    d[axis] = side % 2 == 0 ? lo[axis] : hi[axis];
    const double free = -(m.g[along] + m.H(0, 1) * d[axis]) / m.H(along, along);
    d[along] = std::clamp(free, lo[along], hi[along]);
    const double value = modelValue(m, d);
    if (!(value < lowest)) continue;
    lowest = value;
    best.d = d;
    best.sides = bit(side);
    if (d[along] == lo[along]) best.sides |= bit(2 * along);
    if (d[along] == hi[along]) best.sides |= bit(2 * along + 1);
  }
  for (int axis = 0; axis < 2; ++axis) {  // if the foot stays on its side, make the Newton step along this side
    const int along = 1 - axis;
    if ((best.sides & (bit(2 * axis) | bit(2 * axis + 1))) == 0 || best.d[axis] != 0 || !(m.sided[along] > 0)) continue;
    const double d = -m.g[along] / m.sided[along];
    if (d > lo[along] && d < hi[along] && best.d[along] > lo[along] && best.d[along] < hi[along]) best.d[along] = d;
  }
  return best;
}

/// Bends a long step, because the parameterisation is far from linear near a control point of large weight. To second
/// order the bent step reaches the point of the surface at which the straight step aims (geodesic acceleration,
/// Transtrum & Sethna 2012). Near convergence the bend vanishes and the step is a Newton step.
Vector2d bent(const spline::SurfacePoint& E, const Vector2d& d, const Vector2d& lo, const Vector2d& hi) noexcept {
  constexpr double kStraight = 0.1, kTooBent = 0.75;
  constexpr double kPole = 0.01;  // near a collapsed side the second-order model of the parameterisation is useless
  const Vector3d along_u = (hi[0] - lo[0]) * E.Su, along_v = (hi[1] - lo[1]) * E.Sv;
  if (along_u.cross(along_v).norm() < kPole * std::max(along_u.squaredNorm(), along_v.squaredNorm())) return d;
  const Vector3d acceleration = d[0] * d[0] * E.Suu + 2 * d[0] * d[1] * E.Suv + d[1] * d[1] * E.Svv;
  const Matrix2d G = damped(E);
  const double det = G(0, 0) * G(1, 1) - G(0, 1) * G(0, 1);
  const double a = -0.5 * E.Su.dot(acceleration), b = -0.5 * E.Sv.dot(acceleration);
  const Vector2d bend((a * G(1, 1) - b * G(0, 1)) / det, (b * G(0, 0) - a * G(0, 1)) / det);
  const double ratio = (E.Su * bend[0] + E.Sv * bend[1]).norm() / (E.Su * d[0] + E.Sv * d[1]).norm();
  if (!(ratio > kStraight)) return d;
  const double t = std::min(1.0, kTooBent / ratio);
  const Vector2d curved = t * d + t * t * bend;
  const bool inside = (curved.array() > lo.array()).all() && (curved.array() < hi.array()).all();
  return inside ? curved : d;
}

/// Returns the step from an evaluated point to the minimum in the box. The step is at most twice the distance to the
/// probe, because the new foot is not farther from the probe than this point. At a saddle with vanishing gradient, the
/// step leads out of the saddle.
Step stepFrom(const Patch& patch, const Array2d& uv, const spline::SurfacePoint& E, const Vector3d& r,
              double enough) noexcept {
  constexpr double kVanishingGradient = 1e-6;
  const QuadraticModel m = modelOf(E, r);
  const Vector2d lo = patch.lo - uv, hi = patch.hi - uv;
  Step step = boxMinimum(m, lo, hi);
  const double distance = r.norm();
  const double length = (E.Su * step.d[0] + E.Sv * step.d[1]).norm();
  step.leaves = m.saddle && step.sides == 0;
  if (step.leaves && length < std::max(kVanishingGradient * distance, enough)) {
    const double along = m.g.dot(m.escape) > 0 ? -0.5 : 0.5;
    const auto inBox = [&](double way) { return Vector2d((way * m.escape).cwiseMax(lo).cwiseMin(hi)); };
    step.d = inBox(along * distance);
    if (step.d == Vector2d(0, 0)) step.d = inBox(-along * distance);  // a side is in the way
    step.straight = step.d;
    return step;
  }
  if (length > 2 * distance && length > 0) {
    step.d *= 2 * distance / length;
    step.sides = 0;
  }
  step.straight = step.d;
  if (step.sides == 0) step.d = bent(E, step.d, lo, hi);
  return step;
}

/// Computes normal, height and distance of a foot from its tangents.
void look(LocalFoot& foot, const Patch& patch, const Vector3d& p, const Vector3d& Su, const Vector3d& Sv) noexcept {
  // sine of the angle between the tangents, or ratio of their lengths; below it the point is a pole or a cusp
  constexpr double kVanishing = 1e-9;
  const Vector3d n = Su.cross(Sv), r = p - foot.S;
  const double length = n.norm();
  foot.regular = length > kVanishing * (Su.squaredNorm() + Sv.squaredNorm());
  foot.normal = n * (patch.sign / length);
  foot.height = r.dot(foot.normal);
  foot.distance = r.norm();
}

/// Computes the foot at uv + d by Taylor expansion about the evaluated point, if the step is too small to be worth an
/// evaluation.
void moveTo(LocalFoot& foot, const Patch& patch, const Vector3d& p, const Iterate& at, const Step& step) noexcept {
  const spline::SurfacePoint& E = at.E;
  const double du = step.d[0], dv = step.d[1];
  const Vector3d Su = E.Su + du * E.Suu + dv * E.Suv, Sv = E.Sv + du * E.Suv + dv * E.Svv;
  foot.S = E.S + 0.5 * (du * (E.Su + Su) + dv * (E.Sv + Sv));
  foot.uv = (at.uv + step.d.array()).max(patch.lo).min(patch.hi);
  for (int side = 0; side < kSides; ++side)
    if (step.sides & bit(side)) foot.uv[Patch::axisOf(side)] = side % 2 == 0 ? patch.lo[side / 2] : patch.hi[side / 2];
  foot.sides = step.sides;
  look(foot, patch, p, Su, Sv);
}

void evaluate(const Patch& patch, const Array2d& uv, Iterate& at) noexcept {
  at.uv = uv.max(patch.lo).min(patch.hi);
  patch.surface.evaluate2(at.uv[0], at.uv[1], at.E);
  at.known = Iterate::Known::kPoint;
}

constexpr std::size_t kStride = spline::kOutStride * sizeof(double);
static_assert(offsetof(LocalFoot, S) == offsetof(LocalFoot, uv) + kStride);
static_assert(offsetof(LocalFoot, normal) == offsetof(LocalFoot, uv) + 2 * kStride);
static_assert(offsetof(LocalFoot, distance) == offsetof(LocalFoot, uv) + 3 * kStride);
static_assert(offsetof(LocalFoot, residual) == offsetof(LocalFoot, distance) + sizeof(double));
static_assert(offsetof(LocalFoot, height) == offsetof(LocalFoot, distance) + 2 * sizeof(double));

/// Returns the cell of an evaluated point, less a margin at the poles of the patch: there, warm steps end too early,
/// and descend() takes over.
spline::TableCell cellOf(const Patch& patch, const spline::SurfacePoint& E) noexcept {
  constexpr double kMargin = 1e-5;  // share of the range of the parameter
  spline::TableCell cell = patch.surface.cellOf(E);
  for (int side = 0; side < kSides; ++side) {
    if (patch.side(side).kind != SideKind::kPole) continue;
    const int axis = Patch::axisOf(side);
    const double margin = kMargin * (patch.hi[axis] - patch.lo[axis]);
    if (side % 2 == 0) cell.lo[axis] = std::max(cell.lo[axis], patch.lo[axis] + margin);
    if (side % 2 == 1) cell.end[axis] = std::min(cell.end[axis], patch.hi[axis] - margin);
  }
  return cell;
}

bool evaluateInside(WarmStepState& state, double u, double v, double* point) noexcept {
  const auto& patch = *static_cast<const Patch*>(state.patch);
  if (!(u > patch.lo[0] && u < patch.hi[0] && v > patch.lo[1] && v < patch.hi[1])) return false;
  auto& E = *reinterpret_cast<spline::SurfacePoint*>(point);
  patch.surface.evaluate2(u, v, E);
  state.cell = cellOf(patch, E);
  return true;
}

void prepare(const Patch& patch, Iterate& at) noexcept {
  static const WarmStepKernels& kernels = warmStepKernels(spline::Instructions::kFastest);
  kernels.forms(at.E.S.data(), at.state);
  at.state.calm2 = 0;
  at.state.sign = patch.sign;
  at.state.cell = cellOf(patch, at.E);
  at.state.evaluate = evaluateInside;
  at.state.patch = &patch;
  at.state.step = kernels.step;
  at.known = Iterate::Known::kAll;
}

/// The vector r from the probe to the point of an iterate, and f = |r|^2 / 2, which Newton's method minimizes.
struct Gap {
  Vector3d r;
  double f;
};

Gap gapOf(const Iterate& at, const Vector3d& p) noexcept {
  const Vector3d r = at.E.S - p;
  return {r, 0.5 * r.squaredNorm()};
}

/// Returns (u, v) after a share of a step. A whole step ends exactly on the sides in step.sides.
Array2d targetOf(const Patch& patch, const Iterate& at, const Step& step, double share) noexcept {
  Array2d target = at.uv + share * step.d.array();
  if (share == 1)
    for (int axis = 0; axis < 2; ++axis) {
      if (step.sides & bit(2 * axis)) target[axis] = patch.lo[axis];
      if (step.sides & bit(2 * axis + 1)) target[axis] = patch.hi[axis];
    }
  return target;
}

/// Goes along a step, and shortens it until the point is not farther from the probe than before, except for `rounding`
/// [m]. @return the share of the step that was made; 0 if max_evaluations was reached before
double advance(const Patch& patch, const Vector3d& p, Step& step, int max_evaluations, double rounding, Iterate& at,
               Gap& gap, LocalFoot& foot) noexcept {
  double share = 1;
  while (foot.evaluations < max_evaluations) {
    Iterate trial;
    trial.E.span = at.E.span;
    evaluate(patch, targetOf(patch, at, step, share), trial);
    ++foot.evaluations;
    const Gap tried = gapOf(trial, p);
    if (tried.f <= gap.f + rounding * std::sqrt(2 * gap.f)) {
      at = trial;
      gap = tried;
      return share;
    }
    if (step.d != step.straight) {
      step.d = step.straight;
      continue;
    }
    const double slope = share * Vector2d(gap.r.dot(at.E.Su), gap.r.dot(at.E.Sv)).dot(step.d);
    share *= std::clamp(-0.5 * slope / (tried.f - gap.f - slope), 0.1, 0.5);
  }
  return 0;
}

/// Moves a foot that is almost at a pole to the pole. All steps around a pole are short there, even those of a foot on
/// the far side of it, which would seem to have converged. From the pole itself, Tracer::leavePole() finds the way.
void snapToPole(const Patch& patch, const Iterate& at, double enough, Step& step) noexcept {
  constexpr double kTurns = 4, kMost = 1e-5;  // a step around the pole is as long as the distance to it, or some times
  for (int side = 0; side < kSides; ++side) {
    if (patch.side(side).kind != SideKind::kPole) continue;
    const int axis = Patch::axisOf(side);
    const double way = (side % 2 == 0 ? patch.lo : patch.hi)[axis] - at.uv[axis];
    const double distance = std::abs(way - step.d[axis]) * (axis == 0 ? at.E.Su : at.E.Sv).norm();
    if (!(distance <= std::min(kTurns * enough, kMost))) continue;
    step.d[axis] = way;
    step.sides |= bit(side);
  }
}

/// True if the tangents change so much along a step that its end must be evaluated. The bend of a surface may be as
/// small as the allowed error of the foot; then the normal at the foot would not be that of the surface.
bool turns(const Patch& patch, const spline::SurfacePoint& E, const Step& step) noexcept {
  constexpr double kMost = 0.3;  // change, relative to the tangent
  for (int side = 0; side < kSides; ++side)
    if ((step.sides & bit(side)) && patch.side(side).kind == SideKind::kPole) return false;
  const Vector3d turn_u = step.d[0] * E.Suu + step.d[1] * E.Suv, turn_v = step.d[0] * E.Suv + step.d[1] * E.Svv;
  return turn_u.squaredNorm() > kMost * kMost * E.Su.squaredNorm() ||
         turn_v.squaredNorm() > kMost * kMost * E.Sv.squaredNorm();
}

}  // namespace

void startNewton(const Patch& patch, Iterate& at, LocalFoot& foot) noexcept {
  if (at.known == Iterate::Known::kParameters) {
    evaluate(patch, at.uv, at);
    ++foot.evaluations;
  }
  prepare(patch, at);
}

bool mayStepAgain(const Patch& patch, WarmStepResult result, Iterate& at, LocalFoot& foot) noexcept {
  if (result == WarmStepResult::kNearer) ++foot.evaluations;
  if (result == WarmStepResult::kFarther) {
    evaluate(patch, at.uv, at);  // restores the point before the step, which costs less than a copy in every tick
    foot.evaluations += 2;
  }
  return result == WarmStepResult::kNearer;
}

void descend(const Patch& patch, const Vector3d& p, Iterate& at, double tolerance, int max_evaluations,
             LocalFoot& foot) noexcept {
  foot.converged = false;
  Gap gap = gapOf(at, p);
  const double rounding = kRounding * (p.norm() + at.E.S.norm());
  const double enough = std::max(tolerance, rounding);
  double last_length = 0;         // length of the step that led to this point, or 0
  Array2d last_tangents2(0, 0);   // squared lengths of Su and Sv before that step
  constexpr double kAlike2 = 16;  // largest ratio of squared tangents before and after a step
  Step step;
  double length = 0;
  for (;;) {
    step = stepFrom(patch, at.uv, at.E, gap.r, enough);
    length = (at.E.Su * step.d[0] + at.E.Sv * step.d[1]).norm();
    // Newton's method squares the error, so the next step would be about length * (length / last_length)^2, unless the
    // last step led into a pole, where a tangent vanishes and the two lengths cannot be compared.
    const double ratio = length / last_length;
    const Array2d tangents2(at.E.Su.squaredNorm(), at.E.Sv.squaredNorm());
    const bool alike = (kAlike2 * tangents2 > last_tangents2).all();
    last_tangents2 = tangents2;
    const bool near = length <= enough || (alike && ratio < 0.1 && 10 * length * ratio * ratio <= enough);
    if (!step.leaves && near) {
      if (length > rounding && turns(patch, at.E, step)) {
        last_length = 0;
      } else {
        foot.converged = true;
        break;
      }
    }
    const double share = advance(patch, p, step, max_evaluations, rounding, at, gap, foot);
    if (share == 0) break;
    last_length = share * length;
  }
  if (foot.converged) {
    snapToPole(patch, at, enough, step);
    moveTo(foot, patch, p, at, step);
  } else {
    moveTo(foot, patch, p, at, Step{{0, 0}, patch.sidesAt(at.uv)});
  }
  foot.residual = foot.converged ? std::min(length, enough) : length;
}

void directFoot(const Patch& patch, const Vector3d& p, Iterate& at, int steps, int max_evaluations,
                LocalFoot& foot) noexcept {
  foot.evaluations = 0;
  if (at.known == Iterate::Known::kParameters) {
    evaluate(patch, at.uv, at);
    ++foot.evaluations;
  }
  Vector2d d{0, 0};
  foot.residual = (at.E.S - p).norm();  // the only bound if no step is made
  for (int i = 0; i < steps && foot.evaluations < max_evaluations; ++i) {
    const Vector3d psi = p - at.E.S;
    const Matrix2d G = damped(at.E);
    const double det = G(0, 0) * G(1, 1) - G(0, 1) * G(0, 1);
    const double a = psi.dot(at.E.Su), b = psi.dot(at.E.Sv);
    d = {(a * G(1, 1) - b * G(0, 1)) / det, (b * G(0, 0) - a * G(0, 1)) / det};
    const Vector3d before = at.E.S;
    evaluate(patch, at.uv + d.array(), at);
    ++foot.evaluations;
    foot.residual = (at.E.S - before).norm();
  }
  foot.uv = at.uv;
  foot.S = at.E.S;
  look(foot, patch, p, at.E.Su, at.E.Sv);
  foot.sides = patch.sidesAt(at.uv);
  foot.converged = true;
}

}  // namespace hapticd::trace
