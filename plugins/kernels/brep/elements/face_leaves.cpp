// SPDX-License-Identifier: MIT
/// Cuts faces that are no planes, quadrics or tori into leaves.
#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/brep/elements/piece_curvature.hpp"
#include "kernels/brep/elements/pieces.hpp"
#include "kernels/spline/refinement.hpp"
#include "kernels/trace/box_tree.hpp"

namespace hapticd::brep {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Array2d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using spline::SurfacePoint;

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

}  // namespace

void cutFace(const Geometry& geometry, std::uint32_t face, const FaceShape& shape, std::vector<BoxedLeaf>& leaves) {
  FaceCutter(geometry, face, shape, leaves).run();
}

}  // namespace hapticd::brep
