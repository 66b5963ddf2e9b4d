// SPDX-License-Identifier: MIT
#include "kernels/brep/geometry/trim_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hapticd::brep {
namespace {

using Eigen::Vector2d;

class Cutter {
 public:
  Cutter(const Geometry& geometry, const Face& face, std::vector<TrimPiece>& pieces)
      : geometry_(geometry),
        part_(geometry.part()),
        surface_(face.surface),
        range_(vec(face.hi) - vec(face.lo)),
        pieces_(pieces) {}

  void addLoop(const Loop& loop, LoopGaps& gaps) {
    constexpr double kGap = 1e-3;  // relative to the face's range
    for (std::uint32_t i = 0; i < loop.count; ++i) {
      const Coedge& c = part_.coedges[loop.first + i];
      const Vector2d to = startOf(part_.coedges[loop.first + (i + 1) % loop.count]), end = endOf(c);
      const bool gap = ((to - end).cwiseAbs().array() > kGap * range_.array()).any();
      const Vector2d from = startOf(c), joint = gap ? end : to;
      const bool reversed = (c.flags & kReversed) != 0;
      addCurve(c, reversed ? joint : from, reversed ? from : joint);
      if (!gap) continue;
      ++gaps.count;
      gaps.widest = std::max(gaps.widest, (pointAt(to) - pointAt(end)).norm());
      pieces_.push_back({end, to, 0, 1, 0, 0, 0, TrimPiece::Kind::kLine, 0});
    }
  }

 private:
  Eigen::Vector3d pointAt(const Vector2d& uv) const {
    spline::SurfacePoint at;
    geometry_.surface(surface_, uv[0], uv[1], at);
    return at.S;
  }
  Vector2d at(const Coedge& c, double t) const { return geometry_.planeCurve(c.pcurve, t).c; }
  Vector2d startOf(const Coedge& c) const { return at(c, (c.flags & kReversed) != 0 ? c.t1 : c.t0); }
  Vector2d endOf(const Coedge& c) const { return at(c, (c.flags & kReversed) != 0 ? c.t0 : c.t1); }

  /// Adds the pieces of one pcurve from `a` at t0 to `b` at t1. These points are the joints with the neighbouring
  /// pcurves.
  void addCurve(const Coedge& c, const Vector2d& a, const Vector2d& b) {
    if (part_.curves2[c.pcurve].kind == CurveKind::kLine || isStraight(c, a, b)) {
      pieces_.push_back({a, b, c.t0, c.t1, 0, 0, c.pcurve, TrimPiece::Kind::kLine, 0});
      return;
    }
    knots_ = innerKnots(c);
    std::vector<double> cuts = turns(c);
    cuts.push_back(c.t1);
    double t = c.t0;
    Vector2d from = a;
    for (const double next : cuts) {
      const Vector2d to = next == c.t1 ? b : at(c, next);
      addMonotone(c, t, next, from, to, 0);
      t = next;
      from = to;
    }
  }

  /// True if a pcurve is a spline that is straight from end to end and never turns back.
  bool isStraight(const Coedge& c, const Vector2d& a, const Vector2d& b) const {
    if (part_.curves2[c.pcurve].kind != CurveKind::kSpline || a == b) return false;
    constexpr int kProbes = 33;
    constexpr double kStraight = 1e-12;  // relative to the face's range
    const Vector2d way = b - a;
    double last = 0;
    for (int i = 1; i < kProbes; ++i) {
      const Vector2d there = at(c, c.t0 + (c.t1 - c.t0) * i / kProbes);
      const double share = (there - a).dot(way) / way.squaredNorm();
      const Vector2d off = there - a - share * way;
      if ((off.cwiseAbs().array() > kStraight * range_.array()).any() || share < last || share > 1) return false;
      last = share;
    }
    return true;
  }

  std::vector<double> innerKnots(const Coedge& c) const {
    std::vector<double> inner;
    for (const double knot : geometry_.planeKnots(c.pcurve))
      if (knot > c.t0 && knot < c.t1) inner.push_back(knot);
    return inner;
  }

  /// Returns the parameters inside the pcurve where u or v turns back, and the knots where a spline has a kink.
  std::vector<double> turns(const Coedge& c) const {
    const Curve2& curve = part_.curves2[c.pcurve];
    std::vector<double> found;
    if (curve.kind == CurveKind::kSpline) {
      sampledTurns(c, found);
    } else {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double t = std::atan2(curve.y[axis], curve.x[axis]);
        const double first = std::ceil((c.t0 - t) / std::numbers::pi);
        constexpr double kMost = 64;
        for (double k = first; k < first + kMost && t + k * std::numbers::pi < c.t1; ++k)
          found.push_back(t + k * std::numbers::pi);
      }
    }
    std::sort(found.begin(), found.end());
    const double narrow = 1e-12 * (c.t1 - c.t0);
    std::vector<double> kept;
    for (const double t : found)
      if (t > c.t0 + narrow && t < c.t1 - narrow && (kept.empty() || t > kept.back() + narrow)) kept.push_back(t);
    return kept;
  }

  void sampledTurns(const Coedge& c, std::vector<double>& found) const {
    std::vector<double> stops{c.t0};
    stops.insert(stops.end(), knots_.begin(), knots_.end());
    stops.push_back(c.t1);
    for (std::size_t s = 1; s + 1 < stops.size(); ++s)
      if (hasKink(c.pcurve, stops[s], stops[s] - stops[s - 1])) found.push_back(stops[s]);
    for (int axis = 0; axis < 2; ++axis) addTurns(c, axis, stops, found);
  }

  /// Adds the parameters where the slope along an axis changes its sign. Slopes that move the curve by less than kFlat
  /// are left out, because rounding alone makes their sign.
  void addTurns(const Coedge& c, int axis, const std::vector<double>& stops, std::vector<double>& found) const {
    constexpr int kSamples = 12;     // per knot span
    constexpr double kFlat = 1e-14;  // relative to the face's range
    const double flat = kFlat * range_[axis] / (c.t1 - c.t0);
    double last_t = c.t0, last = 0;
    for (std::size_t s = 0; s + 1 < stops.size(); ++s)
      for (int i = 0; i <= kSamples; ++i) {
        // at a knot, derivatives are evaluated in the span to its right
        const double share = i < kSamples ? static_cast<double>(i) / kSamples : 1 - 1e-9;
        const double t = stops[s] + share * (stops[s + 1] - stops[s]),
                     slope = geometry_.planeCurve(c.pcurve, t).c1[axis];
        if (!(std::abs(slope) > flat)) continue;
        if (slope * last < 0) found.push_back(i == 0 ? t : turnBetween(c.pcurve, axis, last_t, t));
        last = slope;
        last_t = t;
      }
  }

  /// True if the derivatives on both sides of a knot differ. @param before length of the span that ends at the knot
  bool hasKink(std::uint32_t curve, double knot, double before) const {
    constexpr double kSame = 1e-6;
    const Vector2d left = geometry_.planeCurve(curve, knot - 1e-9 * before).c1;
    const Vector2d right = geometry_.planeCurve(curve, knot).c1;
    return !((left - right).cwiseAbs().maxCoeff() <= kSame * std::min(left.norm(), right.norm()));
  }

  /// Returns the parameter between a and b at which the slope along an axis changes its sign.
  double turnBetween(std::uint32_t curve, int axis, double a, double b) const {
    const auto rises = [&](double t) { return geometry_.planeCurve(curve, t).c1[axis] > 0; };
    const bool rising = rises(a);
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (a + b);
      if (middle <= a || middle >= b) break;
      (rises(middle) == rising ? a : b) = middle;
    }
    return b;
  }

  /// True if a piece is near its parabola. Then only few points of the face lie between the two, and the parabola alone
  /// decides for all others. The deviation is compared with the size of the piece or, if the piece is narrow, with that
  /// of the face. Otherwise halving might never end: where u or v turns back, or where a piece is parallel to u or v
  /// except for rounding, each half deviates as much relative to its size as the whole.
  bool isNear(double off, const Vector2d& way, int axis) const {
    constexpr double kNear = 0.02, kFine = 1e-3, kNarrow = 1e-4;  // relative to the piece, and twice to the face
    return off <= kNear * std::abs(way[axis]) || off <= kFine * range_[axis] ||
           std::abs(way[1 - axis]) <= kNarrow * range_[1 - axis];
  }

  /// Adds a monotone piece, halved until each part is near its parabola.
  void addMonotone(const Coedge& c, double t0, double t1, const Vector2d& a, const Vector2d& b, int depth) {
    constexpr int kDeepest = 12;
    TrimPiece piece{a, b, t0, t1, 0, 0, c.pcurve, TrimPiece::Kind::kOther, 0};
    const Vector2d way = b - a;
    piece.axis = std::abs(way[1]) * range_[0] >= std::abs(way[0]) * range_[1] ? 0 : 1;
    const double off = fitParabola(piece);
    if (isRound(part_.curves2[c.pcurve])) {
      piece.kind = TrimPiece::Kind::kCircle;
    } else if (depth < kDeepest && !isNear(off, way, piece.axis)) {
      const double middle = middleOf(t0, t1);
      const Vector2d there = at(c, middle);
      addMonotone(c, t0, middle, a, there, depth + 1);
      addMonotone(c, middle, t1, there, b, depth + 1);
      return;
    }
    pieces_.push_back(piece);
  }

  /// Returns the knot that is nearest to the middle between t0 and t1, or the middle itself if no knot lies between.
  double middleOf(double t0, double t1) const {
    const double middle = 0.5 * (t0 + t1);
    const auto after = std::lower_bound(knots_.begin(), knots_.end(), middle);
    double best = middle, least = 0.5 * (t1 - t0);
    for (const auto near : {after, after == knots_.begin() ? after : after - 1})
      if (near != knots_.end() && *near > t0 && *near < t1 && std::abs(*near - middle) < least)
        best = *near, least = std::abs(*near - middle);
    return best;
  }

  /// Returns the parameters between t0 and t1, in order, at which the curve is compared with its chord.
  std::vector<double> samplesBetween(double t0, double t1) const {
    constexpr int kFewest = 9, kPerSpan = 4;
    std::vector<double> stops{t0};
    for (auto knot = std::upper_bound(knots_.begin(), knots_.end(), t0); knot != knots_.end() && *knot < t1; ++knot)
      stops.push_back(*knot);
    stops.push_back(t1);
    const int spans = static_cast<int>(stops.size()) - 1, each = std::max(kPerSpan, (kFewest + spans - 1) / spans);
    std::vector<double> samples;
    for (std::size_t s = 0; s + 1 < stops.size(); ++s)
      for (int i = 0; i < each; ++i) samples.push_back(stops[s] + (stops[s + 1] - stops[s]) * i / each);
    samples.push_back(t1);
    return samples;
  }

  static bool isRound(const Curve2& c) {
    constexpr double kRound = 1e-14;
    const double x = std::hypot(c.x[0], c.x[1]), y = std::hypot(c.y[0], c.y[1]);
    return c.kind == CurveKind::kCircle && std::abs(x - y) <= kRound * x &&
           std::abs(c.x[0] * c.y[0] + c.x[1] * c.y[1]) <= kRound * x * y;
  }

  /// Sets the parabola of a piece, by least squares over samples, and returns the largest deviation from it: that at
  /// the samples, plus half of it for the points between them.
  double fitParabola(TrimPiece& piece) const {
    const std::vector<double> samples = samplesBetween(piece.t0, piece.t1);
    double product = 0, square = 0, most = 0;
    for (const bool fitted : {false, true}) {
      for (const double t : samples) {
        const Vector2d there = geometry_.planeCurve(piece.curve, t).c;
        const double share = piece.shareAt(there[1 - piece.axis]), hump = share * (1 - share);
        const double beside = there[piece.axis] - piece.besideAt(share);
        most = std::max(most, std::abs(beside));
        product += hump * beside;
        square += hump * hump;
      }
      if (fitted || !(square > 0)) break;
      piece.bend = static_cast<float>(product / square);
      most = 0;
    }
    const double off = 1.5 * most + 1e-15 * std::max(std::abs(piece.a[piece.axis]), std::abs(piece.b[piece.axis]));
    piece.off = std::nextafter(static_cast<float>(off), std::numeric_limits<float>::infinity());
    return off;
  }

  const Geometry& geometry_;
  const Part& part_;
  std::uint32_t surface_;
  Vector2d range_;
  std::vector<double> knots_;  ///< inner knots of the pcurve that is being cut, ascending
  std::vector<TrimPiece>& pieces_;
};

}  // namespace

std::vector<TrimPiece> trimPieces(const Geometry& geometry, const Face& face, LoopGaps& gaps) {
  std::vector<TrimPiece> pieces;
  Cutter cutter(geometry, face, pieces);
  for (std::uint32_t i = 0; i < face.loop_count; ++i) cutter.addLoop(geometry.part().loops[face.first_loop + i], gaps);
  pieces.shrink_to_fit();
  return pieces;
}

}  // namespace hapticd::brep
