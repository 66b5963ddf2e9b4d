// SPDX-License-Identifier: MIT
/// Surfaces with cusps: their parts keep the shape, and no tangent vanishes in them.
#include "kernels/spline/cusp.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "kernels/spline/refinement.hpp"
#include "kernels/spline/surface.hpp"

namespace hapticd::spline {
namespace {

using Eigen::Vector3d;

/// A ridge of 60 mm: `degree` rows of control points coincide, or lie `apart` [m] from one another. `skew` [m] lifts
/// one corner, so that its sides are no planes.
SurfaceData ridge(int degree, double apart, double skew = 0) {
  SurfaceData data;
  data.degree = {degree, 1};
  data.knots[0].assign(static_cast<std::size_t>(degree) + 1, 0);
  data.knots[0].push_back(0.5);
  data.knots[0].insert(data.knots[0].end(), static_cast<std::size_t>(degree) + 1, 1);
  data.knots[1] = {0, 0, 1, 1};
  for (int row = 0; row < degree + 2; ++row)
    for (const double y : {-0.03, 0.03}) {
      const bool outer = row == 0 || row == degree + 1;
      const double x = outer ? (row == 0 ? -0.03 : 0.03) : apart * (row - 0.5 * (degree + 1));
      data.points.emplace_back(x, y, -std::abs(x) + (outer && y > 0 ? skew : 0));
    }
  return data;
}

/// Returns the distance [m] from p to a surface that is ruled along v: the least distance to one of its rulings.
double distanceTo(const Surface& surface, const Vector3d& p, double u_lo, double u_hi) {
  const auto toRuling = [&](double t) {
    SurfacePoint a, b;
    const double u = std::clamp(0.5 + 0.5 * t * t * t, u_lo, u_hi);  // fine near the ridge
    surface.evaluate1(u, 0, a);
    surface.evaluate1(u, 1, b);
    const Vector3d way = b.S - a.S, r = p - a.S;
    return (r - way * std::clamp(r.dot(way) / way.squaredNorm(), 0.0, 1.0)).norm();
  };
  double t = 0, step = 0.005;
  for (double at = -1; at <= 1; at += step)
    if (toRuling(at) < toRuling(t)) t = at;
  for (int i = 0; i < 200 && step > 1e-14; ++i) {
    const double left = toRuling(t - step), middle = toRuling(t), right = toRuling(t + step);
    if (left < middle || right < middle)
      t += left < right ? -step : step;
    else
      step /= 2;
  }
  return toRuling(t);
}

/// Checks that the parts have the shape of the surface and that their speed across the ridge is even.
void expectRegular(const SurfaceData& data, const std::string& what) {
  const Surface whole(data, Form::kNet);
  const std::vector<SurfaceData> parts = splitAtCreases(data);
  ASSERT_EQ(parts.size(), 2u) << what;
  for (const SurfaceData& part : parts) {
    const Surface surface(part, Form::kNet);
    const auto [lo, hi] = part.domain(0);
    double least = 1e9, most = 0;
    for (int i = 0; i <= 60; ++i)
      for (const double v : {0.0, 0.3, 0.8, 1.0}) {
        const double share = std::pow(i / 60.0, 4);  // most points near the ridge
        SurfacePoint E;
        surface.evaluate1(lo == 0 ? hi + (lo - hi) * share : lo + (hi - lo) * share, v, E);
        const Vector3d along = E.Sv.normalized();
        const double speed = (E.Su - along * along.dot(E.Su)).norm();
        least = std::min(least, speed), most = std::max(most, speed);
        if (i % 12 == 0) {
          EXPECT_LT(distanceTo(whole, E.S, lo, hi), 1e-9) << what << ' ' << E.S.transpose();
        }
      }
    EXPECT_LT(most, 30 * least) << what << ": it may vary as much as the weights do";
  }
}

TEST(Cusp, NearRowsAreGraded) {
  for (const int degree : {2, 3, 5})
    for (const double apart : {1e-9, 1e-7, 1e-5})
      expectRegular(ridge(degree, apart), "degree " + std::to_string(degree) + " apart " + std::to_string(apart));
}

TEST(Cusp, UnevenWeightsOfFlatSidesAreMadeStraight) {
  for (const double weight : {0.01, 0.7, 1.01, 10.0}) {
    SurfaceData data = ridge(3, 0);
    data.weights.assign(data.points.size(), 1);
    data.weights[4] = weight;
    for (const SurfaceData& part : splitAtCreases(data)) EXPECT_EQ(part.degree[0], 3) << weight;
    expectRegular(data, "weight " + std::to_string(weight));
  }
}

TEST(Cusp, UnevenWeightsOfRuledSidesAreGraded) {
  for (const int degree : {2, 3, 7, 12})
    for (const double weight : {0.5, 1.01, 4.0}) {
      SurfaceData data = ridge(degree, 0, 0.01);
      data.weights.assign(data.points.size(), 1);
      data.weights[3] = weight;
      const std::string what = "degree " + std::to_string(degree) + " weight " + std::to_string(weight);
      expectRegular(data, what);
      EXPECT_FALSE(hasDoubtfulCusp(data)) << what;
    }
}

/// Three columns of control points coincide too, and the weights are arbitrary: the surface is four flat pieces.
TEST(Cusp, UnevenWeightsOfFlatPiecesAreNoMatter) {
  SurfaceData data;
  data.degree = {3, 3};
  data.knots = {{{0, 0, 0, 0, .5, 1, 1, 1, 1}, {0, 0, 0, 0, .5, 1, 1, 1, 1}}};
  for (const double x : {-1.0, 0.0, 0.0, 0.0, 1.0})
    for (const double y : {-1.0, 0.0, 0.0, 0.0, 1.0}) {
      data.points.emplace_back(x, y, -std::abs(x) - std::abs(y));
      data.weights.push_back(1 + 0.9 * std::sin(7 * static_cast<double>(data.points.size())));
    }
  const auto parts = splitAtCreases(data);
  ASSERT_EQ(parts.size(), 4u);
  for (const SurfaceData& part : parts) EXPECT_EQ(part.degree, (std::array<int, 2>{1, 1}));
}

TEST(Cusp, ASurfaceThatIsOnlyBentIsNotParted) {
  EXPECT_EQ(splitAtCreases(ridge(3, 1e-3)).size(), 1u);
}

TEST(Cusp, IsDoubtfulIfItsWeightsBendIt) {
  SurfaceData data;
  data.degree = {3, 2};
  data.knots = {{{0, 0, 0, 0, .5, 1, 1, 1, 1}, {0, 0, 0, 1, 1, 1}}};
  for (const double x : {-1.0, 0.0, 0.0, 0.0, 1.0})
    for (const double y : {-1.0, 0.0, 1.0}) data.points.emplace_back(x, y, -std::abs(x) - y * y);
  EXPECT_FALSE(hasDoubtfulCusp(data));
  data.weights.assign(data.points.size(), 1);
  data.weights[4] = 1.5;
  EXPECT_TRUE(hasDoubtfulCusp(data));
}

}  // namespace
}  // namespace hapticd::spline
