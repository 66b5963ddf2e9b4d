// SPDX-License-Identifier: MIT
#include "kernels/brep/pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/brep/piece_curvature.hpp"
#include "kernels/spline/refinement.hpp"
#include "kernels/trace/box_tree.hpp"

namespace hapticd::brep {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Array2d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using spline::CurvePoint;
using spline::SurfacePoint;

/// [rad] (25 degrees) largest turn of the normals of a leaf that is no spline, or of the tangents of a piece of a
/// curve.
constexpr double kLeafTurn = 0.44;
/// [rad] Largest angle between the tangents of a spline leaf and their mean. Tangents that only fan out within the
/// surface count too, so the normals of most leaves turn by far less.
constexpr double kTangentTurn = 0.7;
constexpr int kMostHalvings = 2;  ///< how often a leaf that bends unevenly is halved

/// Computes the principal curvatures at a point, positive toward Su x Sv. Returns false if the tangents vanish.
bool curvatures(const SurfacePoint& E, double& least, double& most) {
  const Vector3d N = E.Su.cross(E.Sv);
  const double E1 = E.Su.squaredNorm(), F1 = E.Su.dot(E.Sv), G1 = E.Sv.squaredNorm(), det = E1 * G1 - F1 * F1;
  if (!(det > 1e-18 * E1 * G1) || !(N.norm() > 0)) return false;
  const Vector3d n = N.normalized();
  const double L = n.dot(E.Suu), M = n.dot(E.Suv), P = n.dot(E.Svv);
  const double mean = (E1 * P - 2 * F1 * M + G1 * L) / (2 * det), gauss = (L * P - M * M) / det;
  const double half = std::sqrt(std::max(mean * mean - gauss, 0.0));
  least = mean - half;
  most = mean + half;
  return true;
}

/// True if tangent and curvature of a curve hardly change at a knot, so that a piece or leaf may go on beyond it.
/// @param narrow how far before the knot the curve is evaluated
bool isSmoothAt(const Geometry& geometry, std::uint32_t curve, double knot, double narrow) {
  constexpr double kSame = 1e-6, kSameCurvature = 0.1;
  CurvePoint C;
  std::array<Vector3d, 2> first, bend;
  for (const std::size_t side : {0, 1}) {
    geometry.curve(curve, side == 0 ? knot - narrow : knot, C);
    const double speed2 = C.C1.squaredNorm();
    if (!(speed2 > 0)) return false;
    first[side] = C.C1;
    bend[side] = (C.C2 - C.C2.dot(C.C1) / speed2 * C.C1) / speed2;
  }
  return (first[0] - first[1]).norm() <= kSame * first[1].norm() &&
         (bend[0] - bend[1]).norm() <= kSameCurvature * std::max(bend[0].norm(), bend[1].norm());
}

/// Returns the parameters between lo and hi at which a surface that is no spline may have a kink along an axis, or its
/// curvature may jump: knots of the curve that it sweeps, or of the spline that it is offset from.
std::vector<double> breaksAlong(const Geometry& geometry, std::uint32_t surface, int axis, double lo, double hi) {
  const Part& part = geometry.part();
  const Surface& s = part.surfaces[surface];
  const double narrow = 1e-9 * (hi - lo);
  std::vector<double> knots, breaks;
  if (s.kind == SurfaceKind::kOffset) return breaksAlong(geometry, s.basis, axis, lo, hi);
  if (s.kind == SurfaceKind::kSpline) knots = splineOf(part, s).knots[static_cast<std::size_t>(axis)];
  const bool swept = s.kind == (axis == 0 ? SurfaceKind::kExtrusion : SurfaceKind::kRevolution);
  if (swept) knots = geometry.curveKnots(s.basis);
  for (const double knot : knots)
    if (knot > (breaks.empty() ? lo : breaks.back()) + narrow && knot < hi - narrow &&
        !(swept && isSmoothAt(geometry, s.basis, knot, narrow)))
      breaks.push_back(knot);
  return breaks;
}

class FaceCutter {
 public:
  FaceCutter(const Geometry& geometry, std::uint32_t face, const FaceShape& shape, std::vector<BoxedLeaf>& leaves)
      : geometry_(geometry),
        face_index_(face),
        face_(geometry.part().faces[face]),
        surface_(geometry.part().surfaces[face_.surface]),
        shape_(shape),
        leaves_(leaves) {}

  void run() {
    if (surface_.kind == SurfaceKind::kSpline)
      cutSpline();
    else
      cutEvenly();
  }

 private:
  /// Cuts a spline surface. The control net of each Bezier piece gives a box that certainly contains the piece.
  void cutSpline() {
    const spline::SurfaceData data = splineOf(geometry_.part(), surface_);
    trace::BoxTree pieces;
    pieces.add(data, 0, 1 - std::cos(kTangentTurn));
    const Array2d lo(data.domain(0)[0], data.domain(1)[0]), hi(data.domain(0)[1], data.domain(1)[1]);
    for (int i = 0; i < pieces.leafCount(); ++i) {
      const trace::Leaf& piece = pieces.leaf(i);
      add(piece.middle - piece.half, piece.middle + piece.half, lo, hi, piece.box);
    }
  }

  /// Cuts a surface of another kind into rows and columns: where it has kinks, and between them so that each turns by
  /// about the same angle. The boxes come from samples, which are blind to kinks.
  void cutEvenly() {
    const Array2d lo = vec(face_.lo).array(), hi = vec(face_.hi).array();
    const std::array<std::vector<double>, 2> stops{stopsAlong(0, lo, hi), stopsAlong(1, lo, hi)};
    for (std::size_t i = 0; i + 1 < stops[0].size(); ++i)
      for (std::size_t j = 0; j + 1 < stops[1].size(); ++j) {
        const Array2d from(stops[0][i], stops[1][j]), to(stops[0][i + 1], stops[1][j + 1]);
        add(from, to, lo, hi, sampledBox(from, to));
      }
  }

  /// Returns the parameters at which the surface is cut along an axis, its ends included.
  std::vector<double> stopsAlong(int axis, Array2d lo, Array2d hi) const {
    std::vector<double> ends = breaksAlong(geometry_, face_.surface, axis, lo[axis], hi[axis]), stops{lo[axis]};
    const int fewest = ends.empty() ? 2 : 1;
    ends.push_back(hi[axis]);
    for (const double end : ends) {
      const double begin = lo[axis] = stops.back();
      hi[axis] = end;
      const int count = std::max(fewest, turnsAlong(axis, lo, hi));
      for (int i = 1; i < count; ++i) stops.push_back(begin + i * (end - begin) / count);
      stops.push_back(end);
    }
    return stops;
  }

  /// Returns into how many parts the surface is cut between lo and hi. @param hi along `axis`, the surface is taken
  /// just before it, because derivatives at a knot are those of the span to the right
  int turnsAlong(int axis, const Array2d& lo, const Array2d& hi) const {
    constexpr int kLines = 5, kSamples = 64, kMost = 256;
    double widest = 0;
    SurfacePoint E;
    for (int line = 0; line < kLines; ++line) {
      Vector3d last = Vector3d::Zero();
      double turn = 0;
      for (int i = 0; i <= kSamples; ++i) {
        Array2d share;
        share[axis] = i < kSamples ? static_cast<double>(i) / kSamples : 1 - 1e-9;
        share[1 - axis] = (line + 0.5) / kLines;
        const Array2d uv = lo + share * (hi - lo);
        geometry_.surface(face_.surface, uv[0], uv[1], E);
        const Vector3d n = E.Su.cross(E.Sv).normalized();
        if (i > 0 && n.allFinite()) turn += std::atan2(n.cross(last).norm(), n.dot(last));
        if (n.allFinite()) last = n;
      }
      widest = std::max(widest, turn);
    }
    constexpr double kLittle = 0.1;  // what turns by less than this share of kLeafTurn needs no cut
    const double parts = widest / kLeafTurn;
    return parts < kLittle ? 1 : std::clamp(static_cast<int>(std::ceil(parts)) + 1, 2, kMost);
  }

  /// Returns a box around samples, enlarged because a surface deviates from its chords by an eighth of the second
  /// differences.
  AlignedBox3d sampledBox(const Array2d& lo, const Array2d& hi) const {
    constexpr int kSamples = 6;
    AlignedBox3d box;
    double sag = 0;
    SurfacePoint E;
    const Array2d h = (hi - lo) / kSamples;
    for (int i = 0; i <= kSamples; ++i)
      for (int j = 0; j <= kSamples; ++j) {
        const Array2d uv = lo + Array2d(i, j) * h;
        geometry_.surface(face_.surface, uv[0], uv[1], E);
        box.extend(E.S);
        sag = std::max(sag,
                       (h[0] * h[0] * E.Suu.norm() + 2 * h[0] * h[1] * E.Suv.norm() + h[1] * h[1] * E.Svv.norm()) / 8);
      }
    const double extent = box.diagonal().norm() / kSamples;
    const Vector3d margin = Vector3d::Constant(kBetweenSamples * sag + 0.1 * extent);
    return {box.min() - margin, box.max() + margin};
  }

  /// Adds the leaf from lo to hi. @param domain_lo,domain_hi where the surface ends
  void add(Array2d lo, Array2d hi, const Array2d& domain_lo, const Array2d& domain_hi, const AlignedBox3d& box,
           int halvings = 0) {
    const Array2d first = vec(face_.lo).array().max(domain_lo), last = vec(face_.hi).array().min(domain_hi);
    lo = lo.max(first);
    hi = hi.min(last);
    if (!(lo < hi).all() || !shape_.trim.mayTouch(lo, hi)) return;
    BoxedLeaf made;
    Leaf& leaf = made.leaf;
    leaf.lo = lo;
    leaf.hi = hi;
    leaf.face = face_index_;
    for (int axis = 0; axis < 2; ++axis) {
      if (lo[axis] <= first[axis]) leaf.borders |= 1u << (2 * axis);
      if (hi[axis] >= last[axis]) leaf.borders |= 2u << (2 * axis);
    }
    measureCurvature(leaf);
    made.box = box;
    made.oriented.box = box;
    leaf.curvature = leafCurvature(geometry_, face_.surface, leaf.lo, leaf.hi, leaf.borders, made.oriented);
    if (const int axis = halvings < kMostHalvings ? roughAxis(leaf) : -1; axis >= 0) {
      Array2d end = hi, begin = lo;
      end[axis] = begin[axis] = 0.5 * (lo[axis] + hi[axis]);
      add(lo, end, domain_lo, domain_hi, box, halvings + 1);
      add(begin, hi, domain_lo, domain_hi, box, halvings + 1);
      return;
    }
    leaves_.push_back(made);
  }

  /// Returns the axis along which the curvature of a leaf varies so much that the bounds in LeafCurvature are too wide
  /// to count the feet of a probe near the centres of curvature. Returns -1 if there is none.
  static int roughAxis(const Leaf& leaf) {
    // largest variation of the second derivative of half the squared distance; the derivative itself is 1 on the
    // surface
    constexpr double kRough = 0.2;
    int axis = -1;
    double worst = kRough;
    for (int i = 0; i < 2; ++i) {
      const double spread =
          static_cast<double>(leaf.curvature.terms.high.of[2 + i].value() - leaf.curvature.terms.low.of[2 + i].value());
      if (!(leaf.curvature.focus[i] != 0 && spread > worst)) continue;
      worst = spread;
      const Array2d run = leaf.curvature.along(i).abs() / (leaf.hi - leaf.lo);
      axis = run[0] > run[1] ? 0 : 1;
    }
    return axis;
  }

  void measureCurvature(Leaf& leaf) const {
    constexpr int kSamples = 4;
    double front = 0, back = 0;
    SurfacePoint E;
    for (int i = 0; i <= kSamples; ++i)
      for (int j = 0; j <= kSamples; ++j) {
        const Array2d uv = leaf.lo + Array2d(i, j) / kSamples * (leaf.hi - leaf.lo);
        geometry_.surface(face_.surface, uv[0], uv[1], E);
        double least = 0, most = 0;
        if (!curvatures(E, least, most)) continue;
        front = std::max(front, shape_.outward > 0 ? most : -least);
        back = std::max(back, shape_.outward > 0 ? -least : most);
      }
    leaf.curvature_front = Coarse::up(kBetweenSamples * front);
    leaf.curvature_back = Coarse::up(kBetweenSamples * back);
  }

  const Geometry& geometry_;
  std::uint32_t face_index_;
  const Face& face_;
  const Surface& surface_;
  const FaceShape& shape_;
  std::vector<BoxedLeaf>& leaves_;
};

/// Returns the box of an elliptic arc along the rows of `frame`, from the extreme points along each row.
AlignedBox3d arcBox(const Curve3& c, double t0, double t1, const Matrix3d& frame) {
  const Vector3d o = frame * vec(c.o), x = frame * vec(c.x), y = frame * vec(c.y);
  const auto at = [&](double t) { return Vector3d(o + std::cos(t) * x + std::sin(t) * y); };
  AlignedBox3d box(at(t0));
  box.extend(at(t1));
  for (int axis = 0; axis < 3; ++axis) {
    const double turn = std::atan2(y[axis], x[axis]);
    for (double k = std::ceil((t0 - turn) / std::numbers::pi); turn + k * std::numbers::pi <= t1; ++k)
      box.extend(at(turn + k * std::numbers::pi));
  }
  return box;
}

class EdgeCutter {
 public:
  EdgeCutter(const Geometry& geometry, std::uint32_t edge, std::vector<BoxedPiece>& pieces)
      : geometry_(geometry),
        edge_index_(edge),
        edge_(geometry.part().edges[edge]),
        curve_(geometry.part().curves3[edge_.curve]),
        pieces_(pieces) {}

  void run() {
    // because of rounding, an edge may end just before or after a knot
    const double narrow = 1e-9 * (edge_.t1 - edge_.t0);
    for (const double knot : geometry_.curveKnots(edge_.curve))
      if (knot > edge_.t0 + narrow && knot < edge_.t1 - narrow) knots_.push_back(knot);
    double from = edge_.t0;
    for (const double knot : knots_)
      if (!isSmoothAt(geometry_, edge_.curve, knot, narrow)) {
        halve(from, knot, 0);
        from = knot;
      }
    halve(from, edge_.t1, 0);
  }

 private:
  /// Returns the knot that is nearest to the middle between t0 and t1, or the middle itself if no knot lies between.
  double middleOf(double t0, double t1) const {
    const double middle = 0.5 * (t0 + t1);
    double best = middle, least = t1 - t0;
    for (const double knot : knots_)
      if (knot > t0 && knot < t1 && std::abs(knot - middle) < least) best = knot, least = std::abs(knot - middle);
    return best;
  }

  /// True if there are knots between t0 and t1, and the curvature varies so much there that the bounds in
  /// PieceCurvature would be too wide for a probe far away.
  bool isRough(double t0, double t1) const {
    if (std::none_of(knots_.begin(), knots_.end(), [&](double knot) { return knot > t0 && knot < t1; })) return false;
    constexpr double kRough = 0.5;  // relative to the curvature in the middle
    const PieceCurvature bend =
        pieceCurvature(geometry_, edge_.curve, t0, t1, pieceFrame(geometry_, edge_.curve, t0, t1));
    return static_cast<double>(bend.curvature_off.value()) > kRough * static_cast<double>(bend.curvature.norm());
  }

  void halve(double t0, double t1, int depth) {
    constexpr int kDeepest = 12;
    CurvePoint C;
    Vector3d first = Vector3d::Zero();
    double turn = 0, curvature = 0;
    for (const double t : pieceSamples(geometry_, edge_.curve, t0, t1)) {
      geometry_.curve(edge_.curve, t, C);
      const double speed = C.C1.norm();
      if (!(speed > 0)) continue;
      if (first.isZero(0)) first = C.C1;
      turn = std::max(turn, std::atan2(C.C1.cross(first).norm(), C.C1.dot(first)));
      curvature = std::max(curvature, C.C1.cross(C.C2).norm() / (speed * speed * speed));
    }
    if ((turn > kLeafTurn || isRough(t0, t1)) && depth < kDeepest) {
      const double middle = middleOf(t0, t1);
      halve(t0, middle, depth + 1);
      halve(middle, t1, depth + 1);
      return;
    }
    add(t0, t1, kBetweenSamples * curvature);
  }

  void add(double t0, double t1, double most_curvature) {
    BoxedPiece made;
    made.piece.t0 = t0;
    made.piece.t1 = t1;
    made.piece.edge = edge_index_ & CurvePiece::kMostEdges;
    made.piece.ends = (t0 <= edge_.t0 ? 1u : 0u) | (t1 >= edge_.t1 ? 2u : 0u);
    const PieceFrame along = pieceFrame(geometry_, edge_.curve, t0, t1);
    made.piece.curvature = pieceCurvature(geometry_, edge_.curve, t0, t1, along);
    made.piece.curvature.most = Coarse::up(most_curvature);
    if (along.tangent.squaredNorm() > 0.5) {  // otherwise the derivative of the curve is 0 in the middle
      made.oriented.frame.row(0) = along.tangent;
      made.oriented.frame.row(1) = along.binormal;
      made.oriented.frame.row(2) = along.tangent.cross(along.binormal);
      addCylinders(along.centre, t0, t1, made.oriented);
    }
    if (curve_.kind == CurveKind::kSpline) {
      netBoxes(t0, t1, made);
    } else {
      made.box = arcBox(curve_, t0, t1, Matrix3d::Identity());
      made.oriented.box = arcBox(curve_, t0, t1, made.oriented.frame);
    }
    pieces_.push_back(made);
  }

  /// Sets the cylinders of `oriented` about the centre of curvature in the middle of the piece.
  void addCylinders(const Vector3d& centre, double t0, double t1, OrientedBox& oriented) const {
    const Vector3d middle = oriented.frame * centre;
    double inner = std::numeric_limits<double>::infinity(), outer = 0, widest = 0, bent = 0, before = t0;
    CurvePoint C;
    for (const double t : pieceSamples(geometry_, edge_.curve, t0, t1)) {
      geometry_.curve(edge_.curve, t, C);
      const Vector3d q = oriented.frame * C.C - middle;
      inner = std::min(inner, std::hypot(q[0], q[2]));
      outer = std::max(outer, std::hypot(q[0], q[2]));
      widest = std::max(widest, t - before);
      bent = std::max(bent, C.C2.norm());
      before = t;
    }
    const double sag = kBetweenSamples / 8 * widest * widest * bent;
    oriented.focus = {middle[0], middle[2]};
    oriented.inner = std::max(0.0, inner - sag);
    oriented.outer = outer + sag;
  }

  /// Sets the boxes of a piece of a spline from its control points, whose hull contains the piece.
  void netBoxes(double t0, double t1, BoxedPiece& made) const {
    const spline::CurveData data = splineOf(geometry_.part(), curve_);
    const auto domain = data.domain();
    for (const Vector3d& point : spline::cut(data, std::max(t0, domain[0]), std::min(t1, domain[1])).points) {
      made.box.extend(point);
      made.oriented.box.extend(made.oriented.frame * point);
    }
  }

  const Geometry& geometry_;
  std::uint32_t edge_index_;
  const Edge& edge_;
  const Curve3& curve_;
  std::vector<double> knots_;  ///< the knots inside the edge, ascending
  std::vector<BoxedPiece>& pieces_;
};

}  // namespace

void cutFace(const Geometry& geometry, std::uint32_t face, const FaceShape& shape, std::vector<BoxedLeaf>& leaves) {
  FaceCutter(geometry, face, shape, leaves).run();
}

void cutEdge(const Geometry& geometry, std::uint32_t edge, std::vector<BoxedPiece>& pieces) {
  EdgeCutter(geometry, edge, pieces).run();
}

}  // namespace hapticd::brep
