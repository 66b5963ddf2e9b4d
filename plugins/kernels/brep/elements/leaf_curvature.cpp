// SPDX-License-Identifier: MIT
#include "kernels/brep/elements/leaf_curvature.hpp"

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
/// Relative to the terms. countFeet() adds up about ten products in single precision, each of which it rounds by 6e-8.
constexpr double kSingleRounding = 1e-6;
/// [rad] normals on both sides of a border that differ by less than this count as equal.
constexpr double kSmoothKink = 1e-6;

/// The frame of a leaf in its middle, before rounding.
struct LeafFrame {
  Vector3d center;
  Matrix3d frame;  ///< rows: unit vectors of the two principal directions and of the normal
  Array2d along[2];
  double principal[2]{0, 0};  ///< [1/m] the principal curvatures
  double focus[2]{0, 0};      ///< LeafCurvature::focus
};

/// A point of a leaf and the derivatives there along the leaf's two directions, see LeafSampler.
struct LeafSample {
  Vector3d S, first[2], second[3];  ///< order of `second`: 11, 22, 12
  double product[3];                ///< S_1 S_1, S_2 S_2, S_1 S_2
};

/// Returns points in the rounded frame F of a leaf: F (S - center). The rounded axes are not quite at right angles. So
/// derivatives d are returned as F^-T d, whose products with points are exactly those of the vectors themselves.
class LeafSampler {
 public:
  explicit LeafSampler(const LeafCurvature& curvature)
      : curvature_(curvature), frame_(curvature.frame()), dual_(frame_.inverse().transpose()) {}

  LeafSample at(const SurfacePoint& E) const {
    const Array2d along[2] = {curvature_.along(0), curvature_.along(1)};
    const auto second = [&](const Array2d& a, const Array2d& b) {
      return Vector3d(dual_ * (a[0] * b[0] * E.Suu + (a[0] * b[1] + a[1] * b[0]) * E.Suv + a[1] * b[1] * E.Svv));
    };
    LeafSample sample;
    sample.S = frame_ * (E.S - curvature_.center());
    const Vector3d first[2] = {along[0][0] * E.Su + along[0][1] * E.Sv, along[1][0] * E.Su + along[1][1] * E.Sv};
    for (int i = 0; i < 2; ++i) {
      sample.first[i] = dual_ * first[i];
      sample.second[i] = second(along[i], along[i]);
      sample.product[i] = first[i].squaredNorm();
    }
    sample.second[2] = second(along[0], along[1]);
    sample.product[2] = first[0].dot(first[1]);
    return sample;
  }

 private:
  const LeafCurvature& curvature_;
  Matrix3d frame_, dual_;
};

/// Sets frame and directions from the middle of a leaf. Returns false if the surface is not regular there.
bool turnToPrincipal(LeafFrame& leaf, const SurfacePoint& E, double size) {
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
  leaf.along[0] = c * first + s * second;
  leaf.along[1] = c * second - s * first;
  leaf.frame.row(0) = c * t1 + s * t2;
  leaf.frame.row(1) = c * t2 - s * t1;
  leaf.frame.row(2) = n;
  leaf.center = E.S;
  // size times curvature; below it, the centre of curvature would be mostly rounding error
  constexpr double kStraight = 1e-4;
  for (int i = 0; i < 2; ++i) {
    const double principal = leaf.principal[i] = form(leaf.along[i], leaf.along[i]);
    leaf.focus[i] = std::abs(principal) * size > kStraight ? 1 / principal : 0;
  }
  return leaf.frame.allFinite();
}

/// Rounds the frame of a leaf. Returns false if a number is too large for that.
bool keepFrame(const LeafFrame& leaf, LeafCurvature& curvature) {
  bool finite = true;
  const auto keep = [&finite](double x, float& to) {
    to = static_cast<float>(x);
    finite = finite && std::isfinite(to);
  };
  for (int k = 0; k < 3; ++k) keep(leaf.center[k], curvature.at[k]);
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 2; ++k) keep(leaf.along[i][k], curvature.directions[i][k]);
    for (int k = 0; k < 3; ++k)
      curvature.rows[i][k] = static_cast<std::int16_t>(std::lround(leaf.frame(i, k) * LeafCurvature::kUnit));
    keep(leaf.focus[i], curvature.focus[i]);
  }
  if (!finite) curvature.focus[0] = curvature.focus[1] = LeafCurvature::kUnknown;
  return finite;
}

/// A term of LeafCurvature in double precision, while it is measured. Then it is rounded, so that it encloses what was
/// measured.
struct MeasuredTerm {
  double low = LeafCurvature::kEndless, high = -LeafCurvature::kEndless;
  Coarse middle[3];
  Vector3d off{0, 0, 0};

  void begin(const Vector3d& vector) {
    for (int i = 0; i < 3; ++i) middle[i] = Coarse::near(vector[i]);
  }
  double middleOf(int i) const { return static_cast<double>(middle[i].value()); }
  /// Widens the term so that it includes one sample.
  void extend(double value, const Vector3d& vector) {
    low = std::min(low, value);
    high = std::max(high, value);
    for (int i = 0; i < 3; ++i) off[i] = std::max(off[i], std::abs(vector[i] - middleOf(i)));
  }
  /// Adds a margin for the points between the samples, and for the rounding by countFeet().
  void widen() {
    const double more = (kLeafBetween - 1) * (high - low);
    low -= more + kSingleRounding * std::abs(low);
    high += more + kSingleRounding * std::abs(high);
    for (int i = 0; i < 3; ++i)
      off[i] = (kLeafBetween + kSingleRounding) * off[i] + kSingleRounding * std::abs(middleOf(i));
  }
};

class MeasuredTerms {
 public:
  MeasuredTerms(const LeafCurvature& curvature, const LeafSample& middle) {
    for (int i = 0; i < 2; ++i) {
      focus_[i] = static_cast<double>(curvature.focus[i]);
      four_[i].begin(middle.first[i]);
      four_[2 + i].begin(middle.second[i]);
    }
    mixed_.begin(middle.second[2]);
  }

  void extend(const LeafSample& s) {
    for (int i = 0; i < 2; ++i) {
      const Vector3d from = s.S - focus_[i] * Vector3d::UnitZ();
      four_[i].extend(from.dot(s.first[i]), s.first[i]);
      four_[2 + i].extend(s.product[i] + from.dot(s.second[i]), s.second[i]);
    }
    mixed_.extend(s.product[2] + s.S.dot(s.second[2]), s.second[2]);
  }

  void keep(LeafCurvature& curvature) {
    LeafCurvature::FourTerms& to = curvature.terms;
    for (int k = 0; k < 4; ++k) {
      four_[k].widen();
      to.low.of[k] = Coarse::down(four_[k].low);
      to.high.of[k] = Coarse::up(four_[k].high);
      for (int i = 0; i < 3; ++i) {
        to.middle[i].of[k] = four_[k].middle[i];
        to.off[i].of[k] = Coarse::up(four_[k].off[i]);
      }
    }
    mixed_.widen();
    curvature.mixed.low = Coarse::down(mixed_.low);
    curvature.mixed.high = Coarse::up(mixed_.high);
    for (int i = 0; i < 3; ++i) {
      curvature.mixed.middle[i] = mixed_.middle[i];
      curvature.mixed.off[i] = Coarse::up(mixed_.off[i]);
    }
  }

 private:
  double focus_[2];
  MeasuredTerm four_[4], mixed_;
};

/// Measures what encloses a leaf: a box in its frame, and cylinders about the centre of curvature of that direction
/// along which the leaf is deeper.
class LeafHull {
 public:
  /// @param corner [m] a corner of the leaf, in the frame of the leaf
  LeafHull(const LeafFrame& leaf, const Vector3d& corner) : leaf_(leaf) {
    const auto depth = [&](int i) { return std::abs(leaf.principal[i]) * corner[i] * corner[i]; };
    bent_ = depth(1) > depth(0) ? 1 : 0;
    turn_.row(0) = Vector3d::Unit(bent_);
    turn_.row(1) = Vector3d::Unit(1 - bent_);
    turn_.row(2) = Vector3d::UnitZ();
    straight_ = leaf.focus[bent_] == 0;
  }
  /// Adds a point. @param S [m] in the frame of the leaf
  void extend(const Vector3d& S) {
    const Vector3d q = turn_ * S;
    box_.extend(q);
    const double radius = std::hypot(q[0], q[2] - leaf_.focus[bent_]);
    inner_ = std::min(inner_, radius);
    outer_ = std::max(outer_, radius);
  }
  /// Returns the hull of the points. @param sag [m] greatest deviation of the leaf from the chords between neighbouring
  /// points, in the frame of the leaf
  OrientedBox with(const Vector3d& sag) const {
    const Vector3d room = turn_ * sag + Vector3d::Constant(1e-12 * (1 + leaf_.center.norm()));
    OrientedBox hull;
    hull.frame = turn_ * leaf_.frame;
    const Vector3d center = hull.frame * leaf_.center;
    hull.box = {box_.min() - room + center, box_.max() + room + center};
    if (straight_) return hull;
    hull.focus = {center[0], center[2] + leaf_.focus[bent_]};
    const double across = std::hypot(room[0], room[2]);
    hull.inner = std::max(inner_ - across, 0.0);
    hull.outer = outer_ + across;
    return hull;
  }

 private:
  const LeafFrame& leaf_;
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

/// Returns the largest absolute value of the mixed second derivative for a probe.
double mostMixed(const LeafCurvature::Term& term, const Float4& q, const Float4& size) noexcept {
  float known = 0, off = 0;
  for (int i = 0; i < 3; ++i) {
    known -= q[i] * term.middle[i].value();
    off += size[i] * term.off[i].value();
  }
  return static_cast<double>(
      std::max(std::abs(term.low.value() + known - off), std::abs(term.high.value() + known + off)));
}

}  // namespace

LeafCurvature leafCurvature(const Geometry& geometry, std::uint32_t surface, const Array2d& lo, const Array2d& hi,
                            std::uint32_t ends, OrientedBox& hull) {
  LeafCurvature curvature;
  if (geometry.part().surfaces[surface].kind == SurfaceKind::kOffset) return curvature;
  SurfacePoint E;
  const Array2d middle = 0.5 * (lo + hi);
  geometry.surface(surface, middle[0], middle[1], E);
  const double size = (hi - lo).matrix().cwiseProduct(Eigen::Vector2d(E.Su.norm(), E.Sv.norm())).norm();
  LeafFrame leaf;
  if (!turnToPrincipal(leaf, E, size) || !keepFrame(leaf, curvature)) return curvature;
  const LeafSampler sampler(curvature);
  MeasuredTerms terms(curvature, sampler.at(E));
  geometry.surface(surface, lo[0], lo[1], E);
  const auto local = [&leaf](const Vector3d& S) { return Vector3d(leaf.frame * (S - leaf.center)); };
  LeafHull about(leaf, local(E.S));
  const Array2d step = (hi - lo) / kLeafIntervals;
  const Array2d end = hi - 1e-9 * (hi - lo);  // at a knot, derivatives are evaluated in the span to its right
  Vector3d sag = Vector3d::Zero();
  for (int i = 0; i <= kLeafIntervals; ++i)
    for (int j = 0; j <= kLeafIntervals; ++j) {
      const Array2d uv = (lo + Array2d(i, j) * step).min(end);
      geometry.surface(surface, uv[0], uv[1], E);
      terms.extend(sampler.at(E));
      about.extend(local(E.S));
      const Vector3d bent = step[0] * step[0] * (leaf.frame * E.Suu).cwiseAbs() +
                            2 * step[0] * step[1] * (leaf.frame * E.Suv).cwiseAbs() +
                            step[1] * step[1] * (leaf.frame * E.Svv).cwiseAbs();
      sag = sag.cwiseMax(kSagBetween / 8 * bent);
    }
  terms.keep(curvature);
  hull = about.with(sag);
  curvature.smooth = goesOnSmoothly(geometry, surface, lo, hi, ends);
  return curvature;
}

LeafFeet countFeet(const LeafCurvature& curvature, const Vector3d& probe) noexcept {
  const auto x = static_cast<float>(probe[0]), y = static_cast<float>(probe[1]), z = static_cast<float>(probe[2]);
  // subtracted in double precision, because near a centre of curvature the difference is small
  const auto z1 = static_cast<float>(static_cast<double>(curvature.focus[0]) - probe[2]),
             z2 = static_cast<float>(static_cast<double>(curvature.focus[1]) - probe[2]);
  const Float4 q{x, y, z, 0}, size{std::abs(x), std::abs(y), std::abs(z), 0};
  const Float4 height{z1, z2, z1, z2}, far = height > Float4{} ? height : -height;
  const LeafCurvature::FourTerms& terms = curvature.terms;
  const Float4 known = height * terms.middle[2].values() - x * terms.middle[0].values() - y * terms.middle[1].values();
  const Float4 off = size[0] * terms.off[0].values() + size[1] * terms.off[1].values() + far * terms.off[2].values();
  const Float4 least = terms.low.values() + known - off, most = terms.high.values() + known + off;
  if (curvature.smooth) {
    const auto kink = static_cast<float>(kSmoothKink) * (size[0] + size[1] + size[2]);
    if (least[0] > kink || most[0] < -kink || least[1] > kink || most[1] < -kink) return {FeetOfLeaf::kNowhere};
    constexpr auto kZero = static_cast<float>(-kLeafRounding);
    if (most[2] < kZero || most[3] < kZero) return {FeetOfLeaf::kNowhere};
  }
  const auto low = static_cast<double>(least[2]), other = static_cast<double>(least[3]);
  if (!(low > 0 && other > 0)) return {};
  const double mixed = mostMixed(curvature.mixed, q, size);
  if (!(low * other > mixed * mixed)) return {};
  const double mean = 0.5 * (low + other), half = 0.5 * (low - other);
  return {FeetOfLeaf::kOne, mean - std::sqrt(half * half + mixed * mixed)};
}

Array2d footNear(const LeafCurvature& curvature, const Array2d& middle, const Vector3d& q) noexcept {
  // below this second derivative, the step of the quadratic model would be too long
  constexpr double kLeastSecond = 0.2;
  Array2d uv = middle;
  for (int i = 0; i < 2; ++i) {
    const double second = 1 - q[2] * curvature.principal(i);
    uv += q[i] / (second > kLeastSecond ? second : 1) * curvature.along(i);
  }
  return uv;
}

}  // namespace hapticd::brep
