// SPDX-License-Identifier: MIT
#include "kernels/brep/leaf_curvature.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hapticd::brep {
namespace {

using Eigen::Array2d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using spline::SurfacePoint;

constexpr int kLeafIntervals = 6;       ///< steps between samples along an axis
constexpr double kLeafBetween = 1.25;   ///< factor by which values between the samples may be larger
constexpr double kSagBetween = 1.5;     ///< the same factor for second derivatives
constexpr double kLeafRounding = 1e-9;  ///< relative to the terms that are compared
/// [rad] normals on both sides of a border that differ by less than this count as equal.
constexpr double kSmoothKink = 1e-6;

/// A point of a leaf and the derivatives there along the leaf's two directions, in the leaf's frame.
struct LeafSample {
  Vector3d S, first[2], second[3];  ///< order of `second`: 11, 22, 12
};

/// Returns the point and its derivatives along the leaf's directions, which are fixed in the parameter plane.
LeafSample leafSample(const LeafCurvature& curvature, const SurfacePoint& E) {
  const auto second = [&](const Array2d& a, const Array2d& b) {
    return Vector3d(curvature.frame *
                    (a[0] * b[0] * E.Suu + (a[0] * b[1] + a[1] * b[0]) * E.Suv + a[1] * b[1] * E.Svv));
  };
  LeafSample sample;
  sample.S = curvature.local(E.S);
  for (int i = 0; i < 2; ++i)
    sample.first[i] = curvature.frame * (curvature.along[i][0] * E.Su + curvature.along[i][1] * E.Sv);
  sample.second[0] = second(curvature.along[0], curvature.along[0]);
  sample.second[1] = second(curvature.along[1], curvature.along[1]);
  sample.second[2] = second(curvature.along[0], curvature.along[1]);
  return sample;
}

/// Sets frame and directions from the middle of a leaf. Returns false if the surface is not regular there.
bool turnToPrincipal(LeafCurvature& curvature, const SurfacePoint& E) {
  const Vector3d across = E.Su.cross(E.Sv);
  const double su = E.Su.norm(), area = across.norm();
  if (!(area > 1e-9 * su * E.Sv.norm()) || !(su > 0)) return false;
  const Vector3d n = across / area, t1 = E.Su / su, t2 = n.cross(t1);
  const double lean = E.Sv.dot(t1), rise = E.Sv.dot(t2);
  const Array2d first(1 / su, 0), second(-lean / (su * rise), 1 / rise);
  const double l = n.dot(E.Suu), m = n.dot(E.Suv), k = n.dot(E.Svv);
  const auto form = [&](const Array2d& a, const Array2d& b) {
    return a[0] * b[0] * l + (a[0] * b[1] + a[1] * b[0]) * m + a[1] * b[1] * k;
  };
  const double angle = 0.5 * std::atan2(2 * form(first, second), form(first, first) - form(second, second));
  const double c = std::cos(angle), s = std::sin(angle);
  curvature.along[0] = c * first + s * second;
  curvature.along[1] = c * second - s * first;
  curvature.frame.row(0) = c * t1 + s * t2;
  curvature.frame.row(1) = c * t2 - s * t1;
  curvature.frame.row(2) = n;
  curvature.center = E.S;
  return curvature.frame.allFinite() && curvature.along[0].allFinite() && curvature.along[1].allFinite();
}

/// A LeafCurvature::Term in double precision, while it is measured.
struct MeasuredTerm {
  double low = 0, high = 0;
  Vector3d middle{0, 0, 0}, off{0, 0, 0};

  LeafCurvature::Term rounded() const {
    constexpr float kUp = std::numeric_limits<float>::infinity();
    LeafCurvature::Term term;
    term.low = std::nextafter(static_cast<float>(low), -kUp);
    term.high = std::nextafter(static_cast<float>(high), kUp);
    term.middle = middle.cast<float>();
    const Vector3d room = off + (middle - term.middle.cast<double>()).cwiseAbs();
    for (int i = 0; i < 3; ++i) term.off[i] = std::nextafter(static_cast<float>(room[i]), kUp);
    return term;
  }
};
struct MeasuredCurvature {
  MeasuredTerm slope[2], second[2], mixed;
};

/// Widens a term so that it includes one sample.
void extendTerm(MeasuredTerm& term, double value, const Vector3d& vector) {
  term.low = std::min(term.low, value);
  term.high = std::max(term.high, value);
  term.off = term.off.cwiseMax((vector - term.middle).cwiseAbs());
}

void extendTerms(MeasuredCurvature& curvature, const double (&focus)[2], const LeafSample& s) {
  for (int i = 0; i < 2; ++i) {
    const Vector3d from = s.S - focus[i] * Vector3d::UnitZ();
    extendTerm(curvature.slope[i], from.dot(s.first[i]), s.first[i]);
    extendTerm(curvature.second[i], s.first[i].squaredNorm() + from.dot(s.second[i]), s.second[i]);
  }
  extendTerm(curvature.mixed, s.first[0].dot(s.first[1]) + s.S.dot(s.second[2]), s.second[2]);
}

/// Starts all terms with the values in the middle of a leaf.
MeasuredCurvature beginTerms(LeafCurvature& curvature, const LeafSample& s, double size) {
  // size times curvature; below it, the centre of curvature would be mostly rounding error
  constexpr double kStraight = 1e-4;
  MeasuredCurvature measured;
  for (int i = 0; i < 2; ++i) {
    const double principal = s.second[i].z();
    curvature.principal[i] = principal;
    curvature.focus[i] = std::abs(principal) * size > kStraight ? 1 / principal : 0;
    measured.slope[i].middle = s.first[i];
    measured.second[i].middle = s.second[i];
    measured.second[i].low = LeafCurvature::kEndless;
    measured.second[i].high = -LeafCurvature::kEndless;
  }
  measured.mixed.middle = s.second[2];
  return measured;
}

/// Rounds a term to single precision, with a margin for the points between the samples.
LeafCurvature::Term widened(MeasuredTerm term) {
  const double more = (kLeafBetween - 1) * (term.high - term.low);
  term.low -= more;
  term.high += more;
  term.off *= kLeafBetween;
  return term.rounded();
}

void keepTerms(const MeasuredCurvature& measured, LeafCurvature& curvature) {
  for (int i = 0; i < 2; ++i) {
    curvature.slope[i] = widened(measured.slope[i]);
    curvature.second[i] = widened(measured.second[i]);
  }
  curvature.mixed = widened(measured.mixed);
}

/// Measures what encloses a leaf: a box in its frame, and cylinders about the centre of curvature of that direction
/// along which the leaf is deeper.
class LeafHull {
 public:
  /// @param corner [m] a corner of the leaf, in the frame of the leaf
  LeafHull(const LeafCurvature& curvature, const Vector3d& corner) : curvature_(curvature) {
    const auto depth = [&](int i) { return std::abs(curvature.principal[i]) * corner[i] * corner[i]; };
    bent_ = depth(1) > depth(0) ? 1 : 0;
    turn_.row(0) = Vector3d::Unit(bent_);
    turn_.row(1) = Vector3d::Unit(1 - bent_);
    turn_.row(2) = Vector3d::UnitZ();
    straight_ = curvature.focus[bent_] == 0;
  }
  /// Adds a point. @param S [m] in the frame of the leaf
  void extend(const Vector3d& S) {
    const Vector3d q = turn_ * S;
    box_.extend(q);
    const double radius = std::hypot(q[0], q[2] - curvature_.focus[bent_]);
    inner_ = std::min(inner_, radius);
    outer_ = std::max(outer_, radius);
  }
  /// Returns the hull of the points. @param sag [m] greatest deviation of the leaf from the chords between neighbouring
  /// points, in the frame of the leaf
  OrientedBox with(const Vector3d& sag) const {
    const Vector3d room = turn_ * sag + Vector3d::Constant(1e-12 * (1 + curvature_.center.norm()));
    OrientedBox hull;
    hull.frame = turn_ * curvature_.frame;
    const Vector3d center = hull.frame * curvature_.center;
    hull.box = {box_.min() - room + center, box_.max() + room + center};
    if (straight_) return hull;
    hull.focus = {center[0], center[2] + curvature_.focus[bent_]};
    const double across = std::hypot(room[0], room[2]);
    hull.inner = std::max(inner_ - across, 0.0);
    hull.outer = outer_ + across;
    return hull;
  }

 private:
  const LeafCurvature& curvature_;
  Matrix3d turn_;
  int bent_ = 0;
  bool straight_ = false;
  Eigen::AlignedBox3d box_;
  double inner_ = LeafCurvature::kEndless, outer_ = 0;
};

/// True if the normals on both sides of one border of a leaf are equal.
bool isSmoothAcross(const Geometry& geometry, std::uint32_t surface, const Array2d& lo, const Array2d& hi, int axis,
                    bool at_high) {
  constexpr int kPlaces = 5;
  // relative to the leaf's width; over this distance curvature turns the normal far less than kSmoothKink
  constexpr double kBeside = 1e-8;
  for (int k = 0; k < kPlaces; ++k) {
    std::array<Vector3d, 2> normals;
    for (std::size_t side = 0; side < 2; ++side) {
      Array2d at = lo + (k + 0.5) / kPlaces * (hi - lo);
      at[axis] = (at_high ? hi : lo)[axis] + (side == 0 ? -kBeside : kBeside) * (hi - lo)[axis];
      SurfacePoint E;
      geometry.surface(surface, at[0], at[1], E);
      normals[side] = E.Su.cross(E.Sv).normalized();
    }
    if (!((normals[0] - normals[1]).norm() < 0.1 * kSmoothKink)) return false;
  }
  return true;
}

/// True if the normals are equal on both sides of every border, except those where the surface ends.
bool goesOnSmoothly(const Geometry& geometry, std::uint32_t surface, const Array2d& lo, const Array2d& hi,
                    std::uint32_t ends) {
  for (int axis = 0; axis < 2; ++axis)
    for (const bool at_high : {false, true})
      if ((ends & (at_high ? 2u : 1u) << (2 * axis)) == 0 && !isSmoothAcross(geometry, surface, lo, hi, axis, at_high))
        return false;
  return true;
}

/// Returns bounds of a term's derivative for a probe p. @param from o - p
void rangeOfTerm(const LeafCurvature::Term& term, const Vector3d& from, double& low, double& high) noexcept {
  const double known = from.dot(term.middle.cast<double>()), off = from.cwiseAbs().dot(term.off.cast<double>());
  const double rounding = kLeafRounding * (std::abs(known) + off);
  low = static_cast<double>(term.low) + known - off - rounding;
  high = static_cast<double>(term.high) + known + off + rounding;
}

}  // namespace

LeafCurvature leafCurvature(const Geometry& geometry, std::uint32_t surface, const Array2d& lo, const Array2d& hi,
                            std::uint32_t ends, OrientedBox& hull) {
  LeafCurvature curvature;
  if (geometry.part().surfaces[surface].kind == SurfaceKind::kOffset) return curvature;
  SurfacePoint E;
  const Array2d middle = 0.5 * (lo + hi);
  geometry.surface(surface, middle[0], middle[1], E);
  if (!turnToPrincipal(curvature, E)) return curvature;
  const double size = (hi - lo).matrix().cwiseProduct(Eigen::Vector2d(E.Su.norm(), E.Sv.norm())).norm();
  MeasuredCurvature measured = beginTerms(curvature, leafSample(curvature, E), size);
  geometry.surface(surface, lo[0], lo[1], E);
  LeafHull about(curvature, curvature.local(E.S));
  const Array2d step = (hi - lo) / kLeafIntervals;
  const Array2d end = hi - 1e-9 * (hi - lo);  // at a knot, derivatives are evaluated in the span to its right
  Vector3d sag = Vector3d::Zero();
  for (int i = 0; i <= kLeafIntervals; ++i)
    for (int j = 0; j <= kLeafIntervals; ++j) {
      const Array2d uv = (lo + Array2d(i, j) * step).min(end);
      geometry.surface(surface, uv[0], uv[1], E);
      extendTerms(measured, curvature.focus, leafSample(curvature, E));
      about.extend(curvature.local(E.S));
      const Vector3d bent = step[0] * step[0] * (curvature.frame * E.Suu).cwiseAbs() +
                            2 * step[0] * step[1] * (curvature.frame * E.Suv).cwiseAbs() +
                            step[1] * step[1] * (curvature.frame * E.Svv).cwiseAbs();
      sag = sag.cwiseMax(kSagBetween / 8 * bent);
    }
  keepTerms(measured, curvature);
  hull = about.with(sag);
  curvature.smooth = goesOnSmoothly(geometry, surface, lo, hi, ends);
  return curvature;
}

LeafFeet countFeet(const LeafCurvature& curvature, const Vector3d& q) noexcept {
  double low[3], high[3];
  for (int i = 0; i < 2; ++i) {
    const Vector3d from(-q[0], -q[1], curvature.focus[i] - q[2]);
    double least, most;
    rangeOfTerm(curvature.slope[i], from, least, most);
    const double kink = kSmoothKink * q.lpNorm<1>();
    if (curvature.smooth && (least > kink || most < -kink)) return {FeetOfLeaf::kNowhere};
    rangeOfTerm(curvature.second[i], from, low[i], high[i]);
    if (curvature.smooth && high[i] < -kLeafRounding) return {FeetOfLeaf::kNowhere};
  }
  rangeOfTerm(curvature.mixed, -q, low[2], high[2]);
  const double mixed = std::max(std::abs(low[2]), std::abs(high[2]));
  if (!(low[0] > 0 && low[1] > 0 && low[0] * low[1] > mixed * mixed)) return {};
  const double mean = 0.5 * (low[0] + low[1]), half = 0.5 * (low[0] - low[1]);
  return {FeetOfLeaf::kOne, mean - std::sqrt(half * half + mixed * mixed)};
}

Array2d footNear(const LeafCurvature& curvature, const Array2d& middle, const Vector3d& q) noexcept {
  // below this second derivative, the step of the quadratic model would be too long
  constexpr double kLeastSecond = 0.2;
  Array2d uv = middle;
  for (int i = 0; i < 2; ++i) {
    const double second = 1 - q[2] * curvature.principal[i];
    uv += q[i] / (second > kLeastSecond ? second : 1) * curvature.along[i];
  }
  return uv;
}

}  // namespace hapticd::brep
