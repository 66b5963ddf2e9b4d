// SPDX-License-Identifier: MIT
/// Walks about cusps whose rows of control points only nearly coincide, or whose weights are uneven.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "hand.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Two planes of 60 mm that meet on the y axis, as one cubic surface: z = slope |x|. Three rows of control points lie
/// `apart` [m] from one another.
spline::SurfaceData twoPlanes(double slope, double apart) {
  spline::SurfaceData data;
  data.degree = {3, 1};
  data.knots = {{{0, 0, 0, 0, 0.5, 1, 1, 1, 1}, {0, 0, 1, 1}}};
  for (const double x : {-0.03, -apart, 0.0, apart, 0.03})
    for (const double y : {-0.03, 0.03}) data.points.emplace_back(x, y, slope * std::abs(x));
  return data;
}

/// The profile of the surface as a polygon. Its vertices are dense where the surface bends.
class Profile {
 public:
  explicit Profile(const spline::SurfaceData& data) {
    const spline::Surface surface(data, spline::Form::kNet);
    spline::SurfacePoint E;
    for (int i = -kHalf; i <= kHalf; ++i) {
      const double t = static_cast<double>(i) / kHalf;
      surface.evaluate1(0.5 + 0.5 * std::copysign(std::pow(t, 4), t), 0.5, E);
      points_.emplace_back(E.S.x(), E.S.z());
    }
  }
  double distance(const Vector3d& p) const {
    double best = 1e9;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      const Vector2d way = points_[i + 1] - points_[i], r = Vector2d(p.x(), p.z()) - points_[i];
      const double length2 = way.squaredNorm(), share = length2 > 0 ? std::clamp(r.dot(way) / length2, 0.0, 1.0) : 0;
      best = std::min(best, (r - share * way).norm());
    }
    return best;
  }
  double height(const Vector3d& p) const {
    const auto after = std::upper_bound(points_.begin() + 1, points_.end() - 1, p.x(),
                                        [](double x, const Vector2d& point) { return x < point.x(); });
    const Vector2d a = *(after - 1), b = *after;
    return p.z() - (b.x() > a.x() ? std::lerp(a.y(), b.y(), (p.x() - a.x()) / (b.x() - a.x())) : a.y());
  }

 private:
  static constexpr int kHalf = 400;
  std::vector<Vector2d> points_;
};

/// Moves a hand at random about the fold and compares each foot that counts as the nearest with the profile.
/// @param most largest share of ticks whose foot may be uncertain
void expectTrueFeet(const spline::SurfaceData& data, double most, const std::string& what) {
  const Model model({data});
  const Profile profile(data);
  std::mt19937 random(5);
  std::normal_distribution<double> gauss;
  int uncertain = 0, count = 0;
  for (const double reach : {1e-5, 1e-4, 1e-3}) {
    Hand hand{model};
    hand.options = holding(contact::Sides::kFront, 0);
    Vector3d p(0, 0, reach);
    for (int tick = 0; tick < 200; ++tick) {
      p = 0.5 * p + 0.5 * reach * Vector3d(gauss(random), gauss(random), gauss(random));
      const Foot foot = hand.at(p);
      ++count;
      uncertain += foot.status != FootStatus::kNearest;
      if (foot.status != FootStatus::kNearest || profile.distance(p) < 1e-7) continue;
      EXPECT_NEAR((foot.point - p).norm(), profile.distance(p), 1e-7) << what << ' ' << p.transpose();
      EXPECT_EQ(foot.depth > 0, profile.height(p) < 0) << what << ' ' << p.transpose();
    }
  }
  EXPECT_LE(uncertain, most * count) << what;
}

TEST(Cusp, FeetBesideNearRowsAreTheNearest) {
  for (const double slope : {-1.0, 1.0})
    for (const double apart : {1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4})
      expectTrueFeet(twoPlanes(slope, apart), 0.5,
                     "slope " + std::to_string(slope) + " apart " + std::to_string(1e9 * apart) + " nm");
}

TEST(Cusp, FeetBesideUnevenWeightsAreTheNearest) {
  for (const double slope : {-1.0, 1.0})
    for (const double weight : {0.1, 1.01, 10.0})
      for (const std::size_t at : {0u, 4u, 5u}) {
        spline::SurfaceData data = twoPlanes(slope, 0);
        data.weights.assign(data.points.size(), 1);
        data.weights[at] = weight;
        expectTrueFeet(data, 0.1, "slope " + std::to_string(slope) + " weight " + std::to_string(weight));
      }
}

/// A flat sheet, 80 mm square, whose second row of control points lies a little beyond its first one, so that the sheet
/// is folded there by less than that. The first span is short. @param apart [m]
spline::SurfaceData sheetWithFoldedBorder(int degree, double first_span, double apart) {
  spline::SurfaceData data;
  data.degree = {1, degree};
  data.knots[0] = {0, 0, 1, 1};
  data.knots[1].assign(static_cast<std::size_t>(degree) + 1, 0);
  data.knots[1].push_back(first_span);
  data.knots[1].insert(data.knots[1].end(), static_cast<std::size_t>(degree) + 1, 1);
  for (const double x : {-0.04, 0.04})
    for (int row = 0; row < degree + 2; ++row)
      data.points.emplace_back(x, row == 0 ? 0 : row == 1 ? -apart : 0.08 * (row - 1) / degree, 0);
  return data;
}

void expectFootBelow(Hand& hand, const Vector3d& p, const std::string& what) {
  const Foot foot = hand.at(p);
  EXPECT_NEAR((foot.point - p).norm(), std::abs(p.z()), 1e-7) << what << " at " << p.transpose();
}

/// The border is a foot as well, and its parameter is near that of the nearest one. It was taken for the same.
TEST(Cusp, FeetBesideABorderOfNearRowsAreTheNearest) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.035, 0.035), decade(-4, -1.3), height(-1e-3, 1e-3);
  for (const int degree : {3, 4, 5})
    for (const double first_span : {0.5, 0.05, 0.013, 0.001})
      for (const double apart : {1e-9, 1e-7, 1e-6, 1e-5, 8e-5}) {
        const Model model({sheetWithFoldedBorder(degree, first_span, apart)});
        const std::string what = "degree " + std::to_string(degree) + " span " + std::to_string(first_span) +
                                 " apart " + std::to_string(1e9 * apart) + " nm";
        for (int i = 0; i < 30; ++i) {
          Hand hand{model};
          hand.options = holding(contact::Sides::kFront, 0);
          expectFootBelow(hand, {place(random), std::pow(10, decade(random)), height(random)}, what);
        }
      }
}

/// The foot of a hand that was in front of the border is on it. When the hand comes over the sheet, and rests, the
/// search finds the foot below it.
TEST(Cusp, AFootLeavesABorderOfNearRows) {
  for (const double first_span : {0.05, 0.013, 0.001})
    for (const double apart : {1e-6, 1e-5, 8e-5}) {
      const Model model({sheetWithFoldedBorder(3, first_span, apart)});
      Hand hand{model};
      hand.options = holding(contact::Sides::kFront, 0);
      const Vector3d rest(0.01, 8e-4, 1e-4);
      hand.walk({0.01, -3e-3, 1e-4}, rest, 1e-5, [](const Foot&, const Vector3d&) {});
      for (int i = 0; i < 20; ++i) hand.at(rest);
      expectFootBelow(hand, rest, "span " + std::to_string(first_span) + " apart " + std::to_string(apart));
    }
}

/// Slow strokes past a ridge, in front of it: nothing may be felt. With one weight of 1.5, the hand felt 1 N there.
TEST(Cusp, NothingIsFeltInFrontOfARidge) {
  for (const double weight : {1.0, 1.5}) {
    spline::SurfaceData data = twoPlanes(-1, weight == 1 ? 1e-7 : 0);
    data.weights.assign(data.points.size(), 1);
    data.weights[4] = weight;
    const Model model({data});
    const Profile profile(data);
    for (const double aside : {-1e-3, -1.5e-4, 3e-5, 4e-4}) {
      Hand hand{model};
      hand.walk({aside, 1e-3, 3e-3}, {aside, 2e-3, -5e-4}, 5e-5, [&](const Foot& foot, const Vector3d& p) {
        if (profile.height(p) > 1e-7) {
          EXPECT_LE(foot.depth, 0) << weight << ' ' << p.transpose();
        }
      });
    }
  }
}

}  // namespace
}  // namespace hapticd::trace
