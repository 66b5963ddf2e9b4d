// SPDX-License-Identifier: MIT
#include "kernels/spline/refinement.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <set>
#include <stdexcept>

#include "kernels/spline/cusp.hpp"
#include "kernels/spline/grading.hpp"
#include "kernels/spline/line_set.hpp"
#include "kernels/spline/surface.hpp"

namespace hapticd::spline {
namespace {

/// Samples per span along a knot line in the search for a crease. The difference of the normals is a polynomial along
/// the span, so a crease does not vanish at all samples.
constexpr int kCreaseSamples = 5;

void checkRange(const std::string& name, const std::array<double, 2>& domain, double lo, double hi) {
  if (lo >= domain[0] && hi <= domain[1]) return;
  throw std::invalid_argument("'" + name + "': the range from " + std::to_string(lo) + " to " + std::to_string(hi) +
                              " is not inside the domain from " + std::to_string(domain[0]) + " to " +
                              std::to_string(domain[1]));
}

void checkCut(const std::string& name, const std::array<double, 2>& domain, double lo, double hi) {
  checkRange(name, domain, lo, hi);
  if (!(hi - lo >= kNarrowestSpan)) {
    throw std::invalid_argument("'" + name + "': the range from " + std::to_string(lo) + " to " + std::to_string(hi) +
                                " is empty");
  }
}

void insertAll(LineSet& lines, const std::string& name, std::span<const double> added) {
  for (double t : added) {
    checkRange(name, lines.domain(), t, t);
    lines.insert(t);
  }
}

/// Returns all spans of a set of lines as clamped pieces.
std::vector<LineSet> pieces(LineSet lines) {
  const std::vector<double> breaks = lines.breaks();
  for (double t : breaks) lines.raise(t, lines.degree());
  std::vector<LineSet> result;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) result.push_back(lines.part(breaks[i], breaks[i + 1]));
  return result;
}

/// True if the tangent planes of two neighbouring parts differ at (u, v), or the surface folds back on itself there.
bool creased(const Surface& left, const Surface& right, int axis, double u, double v, double smooth_angle) {
  SurfacePoint a, b;
  left.evaluate1(u, v, a);
  right.evaluate1(u, v, b);
  const Eigen::Vector3d na = a.Su.stableNormalized().cross(a.Sv.stableNormalized());
  const Eigen::Vector3d nb = b.Su.stableNormalized().cross(b.Sv.stableNormalized());
  const Eigen::Vector3d &ta = axis == 0 ? a.Su : a.Sv, &tb = axis == 0 ? b.Su : b.Sv;
  if (na.isZero() || nb.isZero()) return ta.stableNormalized().dot(tb.stableNormalized()) < 0;
  const double sine = na.normalized().cross(nb.normalized()).norm();
  return na.dot(nb) < 0 || sine > smooth_angle;
}

bool creasedAlong(const Surface& left, const Surface& right, int axis, double knot, double smooth_angle) {
  const auto across = left.breaks(1 - axis);
  for (std::size_t i = 0; i + 1 < across.size(); ++i) {
    for (int k = 0; k <= kCreaseSamples; ++k) {
      const double t = std::lerp(across[i], across[i + 1], static_cast<double>(k) / kCreaseSamples);
      if (creased(left, right, axis, axis == 0 ? knot : t, axis == 0 ? t : knot, smooth_angle)) return true;
    }
  }
  return false;
}

/// Returns the knots at which a surface must be split, with both ends of the domain.
std::vector<double> partingKnots(const SurfaceData& data, int axis, double smooth_angle) {
  const LineSet lines(data, axis);
  const std::vector<double> breaks = lines.breaks();
  std::set<double> result{breaks.front(), breaks.back()};
  for (std::size_t i = 1; i + 1 < breaks.size(); ++i) {
    const int multiplicity = lines.multiplicity(breaks[i]);
    if (multiplicity < lines.degree()) continue;
    bool parted = multiplicity > lines.degree();
    if (!parted) {
      const Surface left(lines.part(breaks[i - 1], breaks[i]).surface(data, axis), Form::kNet);
      const Surface right(lines.part(breaks[i], breaks[i + 1]).surface(data, axis), Form::kNet);
      parted = creasedAlong(left, right, axis, breaks[i], smooth_angle);
    }
    if (parted) result.insert(breaks[i]);
  }
  for (const double cusp : cuspKnots(data, axis)) {  // and the spans beside it
    const auto at = std::lower_bound(breaks.begin(), breaks.end(), cusp);
    if (at != breaks.begin()) result.insert(*std::prev(at));
    if (at != breaks.end()) result.insert(*at);
    if (at != breaks.end() && std::next(at) != breaks.end()) result.insert(*std::next(at));
  }
  return {result.begin(), result.end()};
}

/// Returns the strips between knots along an axis.
std::vector<SurfaceData> strips(const SurfaceData& surface, int axis, const std::vector<double>& knots) {
  const LineSet lines(surface, axis);
  std::vector<SurfaceData> result;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    result.push_back(lines.part(knots[i], knots[i + 1]).surface(surface, axis));
  return result;
}

/// How a piece beside a cusp became regular.
enum class Regularity : std::uint8_t {
  kStraight,  ///< it is straight along the axis, or not beside a cusp
  kGraded,    ///< its speed was evened out
  kDoubtful   ///< its speed still varies, or its weights bend it so that the distance may have many minima
};

/// Makes a piece regular along an axis.
Regularity makeRegular(const std::vector<double>& cusps, SurfaceData& piece, int axis) {
  if (straighten(piece, axis)) return Regularity::kStraight;
  const double lo = piece.domain(axis)[0], hi = piece.domain(axis)[1];
  if (std::none_of(cusps.begin(), cusps.end(), [=](double cusp) { return cusp == lo || cusp == hi; }))
    return Regularity::kStraight;
  const bool sure = piece.degree[static_cast<std::size_t>(1 - axis)] == 1 || weightsAreAlike(piece, axis);
  return grade(piece, axis) && sure ? Regularity::kGraded : Regularity::kDoubtful;
}

/// The parts of a surface, and whether one beside a cusp is doubtful.
struct Parting {
  std::vector<SurfaceData> parts;
  bool doubtful = false;
};

Parting parting(const SurfaceData& surface, double smooth_angle) {
  const std::vector<double> us = partingKnots(surface, 0, smooth_angle), vs = partingKnots(surface, 1, smooth_angle);
  if (us.size() == 2 && vs.size() == 2) return {{surface}};
  const std::array<std::vector<double>, 2> cusps = {cuspKnots(surface, 0), cuspKnots(surface, 1)};
  const std::vector<SurfaceData> strips_u = strips(surface, 0, us), strips_v = strips(surface, 1, vs);
  Parting result;
  for (std::size_t i = 0; i + 1 < us.size(); ++i) {
    SurfaceData strip = strips_u[i];
    const Regularity along_u = makeRegular(cusps[0], strip, 0);
    for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
      SurfaceData part = LineSet(strip, 1).part(vs[j], vs[j + 1]).surface(strip, 1);
      const Regularity worse = std::max(along_u, makeRegular(cusps[1], part, 1));
      // In a strip that is flat as a whole, only the corners matter, not the curves between its parts.
      const bool flat = worse != Regularity::kStraight &&
                        (isFlatQuad(strips_u[i]) || isFlatQuad(strips_v[j]) ||
                         isFlatQuad(LineSet(strips_u[i], 1).part(vs[j], vs[j + 1]).surface(strips_u[i], 1)));
      if (flat) makeBilinear(part);
      if (isOnlyALine(part, 0) || isOnlyALine(part, 1)) continue;
      result.doubtful = result.doubtful || (worse == Regularity::kDoubtful && !flat);
      result.parts.push_back(std::move(part));
    }
  }
  if (result.parts.empty()) result.parts = {surface};
  return result;
}

}  // namespace

CurveData refine(const CurveData& curve, std::span<const double> added) {
  validate(curve);
  LineSet lines(curve);
  insertAll(lines, curve.name, added);
  return lines.curve(curve.name);
}

SurfaceData refine(const SurfaceData& surface, int axis, std::span<const double> added) {
  validate(surface);
  LineSet lines(surface, axis);
  insertAll(lines, surface.name, added);
  return lines.surface(surface, axis);
}

CurveData cut(const CurveData& curve, double lo, double hi) {
  validate(curve);
  checkCut(curve.name, curve.domain(), lo, hi);
  return LineSet(curve).part(lo, hi).curve(curve.name);
}

SurfaceData cut(const SurfaceData& surface, int axis, double lo, double hi) {
  validate(surface);
  checkCut(surface.name, surface.domain(axis), lo, hi);
  return LineSet(surface, axis).part(lo, hi).surface(surface, axis);
}

std::vector<CurveData> bezierPieces(const CurveData& curve) {
  validate(curve);
  std::vector<CurveData> result;
  for (const LineSet& piece : pieces(LineSet(curve))) result.push_back(piece.curve(curve.name));
  return result;
}

std::vector<SurfaceData> bezierPieces(const SurfaceData& surface) {
  validate(surface);
  std::vector<SurfaceData> result;
  for (const LineSet& strip : pieces(LineSet(surface, 0))) {
    const SurfaceData strip_data = strip.surface(surface, 0);
    for (const LineSet& piece : pieces(LineSet(strip_data, 1))) result.push_back(piece.surface(strip_data, 1));
  }
  return result;
}

std::vector<SurfaceData> splitAtCreases(const SurfaceData& surface, double smooth_angle) {
  validate(surface);
  return parting(surface, smooth_angle).parts;
}

bool hasDoubtfulCusp(const SurfaceData& surface) {
  validate(surface);
  return parting(surface, kSmoothAngle).doubtful;
}

}  // namespace hapticd::spline
