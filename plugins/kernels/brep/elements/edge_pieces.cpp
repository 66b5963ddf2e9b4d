// SPDX-License-Identifier: MIT
/// Cuts elliptic and spline edges into pieces.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/brep/elements/piece_curvature.hpp"
#include "kernels/brep/elements/pieces.hpp"
#include "kernels/spline/refinement.hpp"

namespace hapticd::brep {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using spline::CurvePoint;

/// Returns the box of an elliptic arc along the rows of `frame`, from the extreme points along each row.
AlignedBox3d arcBox(const Curve3& c, double t0, double t1, const Matrix3d& frame) {
  const Vector3d o = frame * vec(c.o), x = frame * vec(c.x), y = frame * vec(c.y);
  const auto at = [&](double t) { return Vector3d(o + std::cos(t) * x + std::sin(t) * y); };
  AlignedBox3d box(at(t0));
  box.extend(at(t1));
  for (int axis = 0; axis < 3; ++axis) {
    const double turn = std::atan2(y[axis], x[axis]);
    const double first = turn + std::numbers::pi * std::ceil((t0 - turn) / std::numbers::pi);
    for (int k = 0; first + k * std::numbers::pi <= t1; ++k) box.extend(at(first + k * std::numbers::pi));
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

void cutEdge(const Geometry& geometry, std::uint32_t edge, std::vector<BoxedPiece>& pieces) {
  EdgeCutter(geometry, edge, pieces).run();
}

}  // namespace hapticd::brep
