// SPDX-License-Identifier: MIT
/// Compares countFeet() and the lower bounds of leaves with a dense grid of points on each leaf.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "kernels/brep/elements/newton_feet.hpp"
#include "kernels/brep/model/model.hpp"
#include "sample_splines.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

constexpr int kGrid = 24;  ///< intervals along each axis

/// Points of a leaf, and their distances from a probe.
class LeafGrid {
 public:
  LeafGrid(const Model& model, const Leaf& leaf) {
    spline::SurfacePoint E;
    for (int i = 0; i <= kGrid; ++i)
      for (int j = 0; j <= kGrid; ++j) {
        const Array2d uv = leaf.lo + Array2d(i, j) / kGrid * (leaf.hi - leaf.lo);
        model.geometry().surface(model.part().faces[leaf.face].surface, uv[0], uv[1], E);
        points_.push_back(E.S);
      }
  }
  void lookFrom(const Vector3d& p) {
    d2_.clear();
    for (const Vector3d& point : points_) d2_.push_back((point - p).squaredNorm());
  }
  double least() const { return *std::min_element(d2_.begin(), d2_.end()); }
  /// Returns (u, v) of the inner points that are nearer to the probe than their eight neighbours.
  std::vector<Array2d> minimaInside(const Leaf& leaf) const {
    std::vector<Array2d> minima;
    for (int i = 1; i < kGrid; ++i)
      for (int j = 1; j < kGrid; ++j)
        if (isMinimum(i, j)) minima.emplace_back(leaf.lo + Array2d(i, j) / kGrid * (leaf.hi - leaf.lo));
    return minima;
  }

 private:
  double at(int i, int j) const { return d2_[static_cast<std::size_t>(i * (kGrid + 1) + j)]; }
  bool isMinimum(int i, int j) const {
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b)
        if ((a != 0 || b != 0) && !(at(i, j) < at(i + a, j + b))) return false;
    return true;
  }

  std::vector<Vector3d> points_;
  std::vector<double> d2_;
};

struct LeafTally {
  int nowhere = 0, one = 0, unknown = 0, passed_over = 0;
};

/// Finds the foot on the whole leaf by Newton's method, as if the surface went on beyond the borders. Returns false if
/// the foot is not proved.
bool footFrom(const Model& model, Leaf leaf, const Array2d& uv, const Vector3d& p, Hit& hit) {
  leaf.borders = 0;
  const LeafStart start{uv, {FeetOfLeaf::kOne}, false};
  return leafFoot(model.geometry(), leaf, model.face(leaf.face), model.part().faces[leaf.face].surface, p, start, hit)
      .proved;
}

/// True if a foot lies inside the leaf. A minimum of the grid may be only a point of a narrow valley, from which
/// Newton's method leads to the border; such a minimum does not count.
bool hasFootInside(const Model& model, const Leaf& leaf, const LeafGrid& grid, const Vector3d& p) {
  const Array2d rounding = 1e-6 * (leaf.hi - leaf.lo);
  for (const Array2d& uv : grid.minimaInside(leaf)) {
    Hit hit;
    if (!footFrom(model, leaf, uv, p, hit)) continue;
    const Array2d at(hit.u, hit.v);
    if ((at > leaf.lo + rounding).all() && (at < leaf.hi - rounding).all()) return true;
  }
  return false;
}

/// Checks that a leaf which is given up after one evaluation is farther away than the limit.
void lookFromAfar(const Model& model, Leaf leaf, const Vector3d& p, const LeafFeet& feet, const LeafGrid& grid,
                  LeafTally& tally) {
  leaf.borders = 0;
  for (const double share : {0.5, 0.9, 0.99, 1.0, 1.01}) {
    LeafStart start{footNear(leaf.curvature, leaf.middle(), leaf.curvature.local(p)), feet, false};
    start.limit2 = share * grid.least();
    Hit hit;
    const std::uint32_t surface = model.part().faces[leaf.face].surface;
    const NewtonResult answer = leafFoot(model.geometry(), leaf, model.face(leaf.face), surface, p, start, hit);
    if (answer.evaluations > 1 || hit.d2 < 1e300) continue;
    ++tally.passed_over;
    EXPECT_LE(answer.untrimmed2, grid.least() * (1 + 1e-9)) << p.transpose();
    EXPECT_GT(answer.untrimmed2, start.limit2) << p.transpose();
  }
}

void lookAtLeaf(const Model& model, const Leaf& leaf, const Vector3d& p, LeafGrid& grid, LeafTally& tally) {
  const Vector3d q = leaf.curvature.local(p);
  grid.lookFrom(p);
  const LeafFeet feet = countFeet(leaf.curvature, q);
  switch (feet.number) {
    case FeetOfLeaf::kNowhere:
      ++tally.nowhere;
      EXPECT_FALSE(hasFootInside(model, leaf, grid, p)) << p.transpose();
      break;
    case FeetOfLeaf::kOne: {
      ++tally.one;
      Hit hit;
      const bool arrived = footFrom(model, leaf, footNear(leaf.curvature, leaf.middle(), q), p, hit);
      EXPECT_TRUE(!arrived || hit.d2 <= grid.least() * (1 + 1e-9) + 1e-18) << p.transpose();
      lookFromAfar(model, leaf, p, feet, grid, tally);
      break;
    }
    default:
      ++tally.unknown;
  }
}

void expectTrueOf(const std::string& file) {
  const Model model(samples::sheetOf(readModelFile(HAPTICD_SOURCE_DIR "/config/models/" + file).surfaces));
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  LeafTally tally;
  for (std::uint32_t i = 0; i < model.leafCount(); ++i) {
    const Leaf& leaf = model.leaf(i);
    LeafGrid grid(model, leaf);
    for (const double away : {1e-4, 1e-3, 1e-2, 0.1})  // [m] distance of the probe from the middle of the leaf
      for (int k = 0; k < 6; ++k) {
        const Vector3d aside(normal(random), normal(random), normal(random));
        const Vector3d p =
            k < 3 ? Vector3d(leaf.curvature.center() + away * aside)
                  : Vector3d(leaf.curvature.center() +
                             away * normal(random) * leaf.curvature.frame().row(2).transpose() + 0.1 * away * aside);
        lookAtLeaf(model, leaf, p, grid, tally);
      }
  }
  const int all = tally.nowhere + tally.one + tally.unknown;
  std::printf("%s: %zu leaves; of %d looks %.1f %% see no foot, %.1f %% one, %.1f %% are not sure\n", file.c_str(),
              model.leafCount(), all, 100.0 * tally.nowhere / all, 100.0 * tally.one / all,
              100.0 * tally.unknown / all);
  EXPECT_GT(tally.nowhere, 0);
  EXPECT_GT(tally.one, 0);
  EXPECT_GT(tally.passed_over, tally.one);
  EXPECT_LT(tally.unknown, 0.55 * all);  // unknown near poles and at centres of curvature
}

TEST(Coarse, RoundsOutward) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10000; ++i) {
    const double x = normal(random) * std::pow(10.0, i % 60 - 30);
    const auto up = static_cast<double>(Coarse::up(x).value()), down = static_cast<double>(Coarse::down(x).value());
    EXPECT_TRUE(down <= x && x <= up) << x;
    EXPECT_LT(up - down, 0.01 * std::abs(x));
    EXPECT_LT(std::abs(static_cast<double>(Coarse::near(x).value()) - x), 0.01 * std::abs(x));
  }
  EXPECT_EQ(Coarse::up(0).value(), 0);
  EXPECT_GT(Coarse::up(1e-50).value(), 0);
  EXPECT_GT(static_cast<double>(Coarse::up(1e300).value()), 1e300);
  EXPECT_TRUE(std::isnan(Coarse::up(std::nan("")).value()));
}

TEST(LeafCurvature, OfTheTeapot) {
  expectTrueOf("teapot.yaml");
}
TEST(LeafCurvature, OfTheGoblet) {
  expectTrueOf("goblet.yaml");
}
TEST(LeafCurvature, OfTheTorus) {
  expectTrueOf("torus.yaml");
}

}  // namespace
}  // namespace hapticd::brep
