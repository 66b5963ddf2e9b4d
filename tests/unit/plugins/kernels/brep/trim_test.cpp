// SPDX-License-Identifier: MIT
/// Tests loops of splines: which points are inside, and into how many pieces the loops are cut.
#include "kernels/brep/geometry/trim.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "kernels/brep/elements/feet.hpp"
#include "kernels/spline/refinement.hpp"
#include "sample_splines.hpp"

namespace hapticd::brep {
namespace {

/// Returns a Bezier pcurve with t from 0 to 1. Its numbers are appended to the part.
Curve2 bezier2(Part& part, const std::vector<Vector2>& points) {
  Curve2 curve;
  curve.kind = CurveKind::kSpline;
  curve.degree = static_cast<std::uint32_t>(points.size()) - 1;
  curve.count = static_cast<std::uint32_t>(points.size());
  curve.data = samples::addReals(part, std::vector<double>(points.size(), 0.0));
  samples::addReals(part, std::vector<double>(points.size(), 1.0));
  for (const Vector2& p : points) samples::addReals(part, {p[0], p[1]});
  return curve;
}

/// Returns the part with a plane face from (0, 0) to `hi`, whose loop consists of the pcurves `sides`.
Part faceOf(Part part, const std::vector<Curve2>& sides, Vector2 hi) {
  Surface plane;
  plane.x = {samples::kMm, 0, 0};
  plane.y = {0, samples::kMm, 0};
  samples::addFace(part, plane, 0, {0, 0}, hi);
  samples::addLoop(part);
  for (const Curve2& side : sides) {
    const std::uint32_t vertex = samples::addVertex(part, {});
    samples::addCoedge(part, samples::addEdge(part, {}, 0, 1, vertex, vertex), side, 0);
  }
  samples::endBody(part, BodyKind::kSheet, 0);
  return part;
}

/// Checks random points of the face, every other one within 1e-7 of the curve. They must be inside exactly if they are
/// below the curve by its formula. @param above returns v of the curve at u
void expectInside(const Trim& trim, Vector2 hi, const std::function<double(double u, double v)>& above) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const double u = share(random) * hi[0], height = above(u, 0);
    const double v = i % 2 == 0 ? share(random) * hi[1] : height + (share(random) - 0.5) * 2e-7;
    if (std::abs(v - height) < 1e-14 || v < 0) continue;
    ASSERT_EQ(trim.inside(u, v), v < height) << u << ' ' << v << ", the curve is at " << height;
  }
}

/// Near the point where v turns back, a piece deviates from its chord by as much as its whole extent in v, however
/// often it is halved. So halving must stop by another rule.
TEST(TrimPieces, AreFewAboutTheTurnOfACurve) {
  Part part;
  const Curve2 top = bezier2(part, {{1, 1}, {0.5, 1.4}, {0, 1}});
  const std::vector<Curve2> sides{samples::line2({0, 0}, {1, 0}), samples::line2({1, 0}, {0, 1}), top,
                                  samples::line2({0, 1}, {0, -1})};
  const Part face = faceOf(std::move(part), sides, {1, 1.2});
  const Geometry geometry(face, spline::Form::kTable);
  const Trim trim(geometry, face.faces[0]);
  expectInside(trim, {1, 1.2}, [](double u, double) { return 1 + 0.8 * u * (1 - u); });
  EXPECT_LT(trim.bytes(), 6000u);
}

/// Exporters write simple curves as splines of many spans. A piece may run over several of them.
TEST(TrimPieces, AreFewAlongACurveOfManySpans) {
  spline::CurveData curve;
  curve.degree = 2;
  curve.knots = {0, 0, 0, 1, 1, 1};
  curve.points = {{1, 1, 0}, {0.5, 1.4, 0}, {0, 1, 0}};
  std::vector<double> added;
  for (int i = 1; i < 40; ++i) added.push_back(i / 40.0);
  curve = spline::refine(curve, added);
  Part part;
  Curve2 top;
  top.kind = CurveKind::kSpline;
  top.degree = 2;
  top.count = static_cast<std::uint32_t>(curve.points.size());
  top.data = samples::addReals(part, curve.knots);
  for (const Eigen::Vector3d& p : curve.points) samples::addReals(part, {p[0], p[1]});
  const std::vector<Curve2> sides{samples::line2({0, 0}, {1, 0}), samples::line2({1, 0}, {0, 1}), top,
                                  samples::line2({0, 1}, {0, -1})};
  const Part face = faceOf(std::move(part), sides, {1, 1.2});
  const Geometry geometry(face, spline::Form::kTable);
  const Trim trim(geometry, face.faces[0]);
  expectInside(trim, {1, 1.2}, [](double u, double) { return 1 + 0.8 * u * (1 - u); });
  EXPECT_LT(trim.bytes(), 1000u);
}

/// Exporters write lines as splines whose points have rounding errors. Each half of such a piece deviates from its
/// chord by as much as the width of the whole piece.
TEST(TrimPieces, AreFewAlongASideThatIsStraightButForRounding) {
  constexpr double kOff = 4e-12;
  Part part;
  const Curve2 right = bezier2(part, {{1, 0}, {1 + kOff, 0.3}, {1 - kOff, 0.6}, {1 + kOff, 0.8}, {1, 1}});
  const Curve2 top = bezier2(part, {{1, 1}, {0.6, 1 + kOff}, {0.3, 1 - kOff}, {0, 1}});
  const std::vector<Curve2> sides{samples::line2({0, 0}, {1, 0}), right, top, samples::line2({0, 1}, {0, -1})};
  const Part face = faceOf(std::move(part), sides, {1, 1});
  const Geometry geometry(face, spline::Form::kTable);
  const Trim trim(geometry, face.faces[0]);
  EXPECT_LT(trim.bytes(), 3000u);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-0.1, 1.1);
  for (int i = 0; i < 20000; ++i) {
    const double u = share(random), v = share(random);
    ASSERT_EQ(trim.inside(u, v), u > 0 && u < 1 && v > 0 && v < 1) << u << ' ' << v;
  }
}

/// The sides are parallel to v except for the last bit, and a border of the grid lies between the u of their ends. The
/// path from a point beside the border must cross the side exactly once: to the right or above.
TEST(Trim, DecidesHolesWithNearlyUprightSides) {
  for (int column = 1; column < 5; ++column)
    for (const bool leans_right : {true, false}) {
      const double left = 0.2 * column, end = std::nextafter(left, leans_right ? 1.0 : 0.0), right = left + 0.1;
      const Vector2 corners[] = {{left, 0.13}, {right, 0.13}, {right, 0.77}, {end, 0.77}};
      const std::vector<Curve2> sides{samples::line2({0, 0}, {1, 0}), samples::line2({1, 0}, {0, 1}),
                                      samples::line2({1, 1}, {-1, 0}), samples::line2({0, 1}, {0, -1})};
      Part part = faceOf({}, sides, {1, 1});
      samples::addLoop(part);
      for (std::size_t k = 4; k > 0; --k) {
        const Vector2 &from = corners[k % 4], &to = corners[k - 1];
        const std::uint32_t vertex = samples::addVertex(part, {});
        samples::addCoedge(part, samples::addEdge(part, {}, 0, 1, vertex, vertex),
                           samples::line2(from, {to[0] - from[0], to[1] - from[1]}), 0);
      }
      const Geometry geometry(part, spline::Form::kTable);
      const Trim trim(geometry, part.faces[0]);
      std::mt19937 random(3);
      std::uniform_real_distribution<double> share(0.01, 0.99);
      for (int i = 0; i < 20000; ++i) {
        const double u = i % 2 == 0 ? share(random) : left + 0.05 * (share(random) - 0.5), v = share(random);
        const bool in_hole = u > left && u < right && v > 0.13 && v < 0.77;
        ASSERT_EQ(trim.inside(u, v), !in_hole) << u << ' ' << v << ", a side at " << left;
      }
    }
}

/// The crest of a thread is a strip that winds nine times around its cylinder, with a pitch of 1 mm and a width of 0.5
/// mm.
TEST(FaceFoot, FindsEachTurnOfAFaceThatWindsAroundItsCylinder) {
  constexpr double kTurn = 2 * std::numbers::pi, kMost = 9 * kTurn;
  Surface cylinder;
  cylinder.kind = SurfaceKind::kCylinder;
  cylinder.x = {1, 0, 0};
  cylinder.y = {0, 1, 0};
  cylinder.z = {0, 0, samples::kMm};
  cylinder.r[0] = 3 * samples::kMm;
  cylinder.period[0] = kTurn;
  Part part;
  samples::addFace(part, cylinder, 0, {0, 0}, {kMost, 9.5});
  samples::addLoop(part);
  for (const Curve2& side : {samples::line2({0, 0}, {kMost, 9}), samples::line2({kMost, 9}, {0, 0.5}),
                             samples::line2({kMost, 9.5}, {-kMost, -9}), samples::line2({0, 0.5}, {0, -0.5})}) {
    const std::uint32_t vertex = samples::addVertex(part, {});
    samples::addCoedge(part, samples::addEdge(part, {}, 0, 1, vertex, vertex), side, 0);
  }
  samples::endBody(part, BodyKind::kSheet, 0);
  const Geometry geometry(part, spline::Form::kTable);
  const FaceShape face = faceShape(geometry, 0);
  for (int turn = 0; turn < 9; ++turn)
    for (const double v : {0.25, 0.75}) {  // one point on the strip, one beside it
      const double u = 1, height = turn + u / kTurn + v;
      const Eigen::Vector3d p(4 * samples::kMm * std::cos(u), 4 * samples::kMm * std::sin(u), height * samples::kMm);
      Hit hit;
      hit.d2 = 1;
      const double d2 = faceFoot(face, p, hit);
      EXPECT_EQ(std::isfinite(d2), v < 0.5) << turn << ' ' << v;
      if (v < 0.5) {
        EXPECT_NEAR(hit.u, u + kTurn * turn, 1e-12);
      }
    }
}

}  // namespace
}  // namespace hapticd::brep
