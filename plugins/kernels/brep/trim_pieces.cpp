// SPDX-License-Identifier: MIT
#include "kernels/brep/trim_pieces.hpp"

#include <algorithm>
#include <cmath>
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
      pieces_.push_back({end, to, 0, 0, 0, TrimPiece::Kind::kLine, 0, 1});
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
      pieces_.push_back({a, b, 0, 0, c.pcurve, TrimPiece::Kind::kLine, c.t0, c.t1});
      return;
    }
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

  /// Returns the parameters inside the pcurve where u or v turns back, and the inner knots of a spline.
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
    constexpr int kSamples = 12;  // per knot span
    std::vector<double> stops{c.t0, c.t1};
    for (const double knot : geometry_.planeKnots(c.pcurve))
      if (knot > c.t0 && knot < c.t1) stops.push_back(knot);
    std::sort(stops.begin(), stops.end());
    for (std::size_t s = 0; s + 1 < stops.size(); ++s) {
      if (s > 0) found.push_back(stops[s]);
      const double step = (stops[s + 1] - stops[s]) / kSamples;
      for (int i = 0; i < kSamples; ++i)
        for (int axis = 0; axis < 2; ++axis)
          bisect(c.pcurve, axis, stops[s] + i * step, stops[s] + (i + 1) * step, found);
    }
  }

  /// Adds to `found` the parameter between low and high at which the slope along an axis changes its sign.
  void bisect(std::uint32_t curve, int axis, double low, double high, std::vector<double>& found) const {
    const double end = high - 1e-9 * (high - low);  // at a knot, derivatives are evaluated in the span to its right
    const auto rises = [&](double t) { return geometry_.planeCurve(curve, t).c1[axis] > 0; };
    const bool rising = rises(low);
    if (rising == rises(end)) return;
    double a = low, b = end;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (a + b);
      if (middle <= a || middle >= b) break;
      (rises(middle) == rising ? a : b) = middle;
    }
    found.push_back(b);
  }

  /// True if a piece is near its chord along u and along v. Then only few points of the face lie between the two, and
  /// the chord alone decides for all others. The deviation is compared with the size of the piece or, if the piece is
  /// narrow, with that of the face. Otherwise halving might never end: where u or v turns back, or where a piece is
  /// parallel to u or v except for rounding, each half deviates as much relative to its size as the whole.
  bool isNear(const Vector2d& off, const Vector2d& way) const {
    constexpr double kNear = 0.05, kNarrow = 1e-4;  // relative to the piece, and to the face
    for (int axis = 0; axis < 2; ++axis) {
      const bool narrow = off[axis] <= kNarrow * range_[axis] || std::abs(way[1 - axis]) <= kNarrow * range_[1 - axis];
      if (!narrow && off[axis] > kNear * std::abs(way[axis])) return false;
    }
    return true;
  }

  /// Adds a monotone piece, halved until each part is near its chord.
  void addMonotone(const Coedge& c, double t0, double t1, const Vector2d& a, const Vector2d& b, int depth) {
    constexpr int kDeepest = 12;
    TrimPiece piece{a, b, 0, 0, c.pcurve, TrimPiece::Kind::kOther, t0, t1};
    const Vector2d off = offChord(c, t0, t1, a, b);
    piece.off_u = std::nextafter(static_cast<float>(off[0]), 1e30F);
    piece.off_v = std::nextafter(static_cast<float>(off[1]), 1e30F);
    if (isRound(part_.curves2[c.pcurve])) {
      piece.kind = TrimPiece::Kind::kCircle;
    } else if (depth < kDeepest && !isNear(off, b - a)) {
      const double middle = 0.5 * (t0 + t1);
      const Vector2d there = at(c, middle);
      addMonotone(c, t0, middle, a, there, depth + 1);
      addMonotone(c, middle, t1, there, b, depth + 1);
      return;
    }
    pieces_.push_back(piece);
  }

  static bool isRound(const Curve2& c) {
    constexpr double kRound = 1e-14;
    const double x = std::hypot(c.x[0], c.x[1]), y = std::hypot(c.y[0], c.y[1]);
    return c.kind == CurveKind::kCircle && std::abs(x - y) <= kRound * x &&
           std::abs(c.x[0] * c.y[0] + c.x[1] * c.y[1]) <= kRound * x * y;
  }

  /// Returns the largest deviation of a piece from its chord along u and along v at samples, plus half of that for the
  /// points between the samples.
  Vector2d offChord(const Coedge& c, double t0, double t1, const Vector2d& a, const Vector2d& b) const {
    constexpr int kSamples = 9;
    Vector2d most(0, 0);
    for (int i = 0; i <= kSamples; ++i) {
      const Vector2d there = at(c, t0 + (t1 - t0) * i / kSamples);
      for (int axis = 0; axis < 2; ++axis) {
        const double run = b[1 - axis] - a[1 - axis];
        const double share = run == 0 ? 0.5 : std::clamp((there[1 - axis] - a[1 - axis]) / run, 0.0, 1.0);
        most[axis] = std::max(most[axis], std::abs(there[axis] - a[axis] - share * (b[axis] - a[axis])));
      }
    }
    return 1.5 * most + 1e-15 * (a.cwiseAbs() + b.cwiseAbs());
  }

  const Geometry& geometry_;
  const Part& part_;
  std::uint32_t surface_;
  Vector2d range_;
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
