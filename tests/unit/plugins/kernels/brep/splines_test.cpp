// SPDX-License-Identifier: MIT
/// Feet on spline faces, compared with dense sampling and with closed forms.
#include <gtest/gtest.h>

#include <random>

#include "kernels/brep/contact/tracer.hpp"
#include "kernels/brep/search/search.hpp"
#include "kernels/trace/model.hpp"
#include "sample_splines.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

const std::string kModels = HAPTICD_SOURCE_DIR "/config/models/";

/// Returns the distance to the nearest point of all patches, by Newton's method from a dense grid on each. This is slow
/// but reliable.
double denseDistance(const std::vector<spline::Surface>& surfaces, const Vector3d& p) {
  constexpr int kRaster = 24;
  double best = 1e9;
  spline::SurfacePoint E;
  for (const spline::Surface& s : surfaces) {
    const auto us = s.domain(0), vs = s.domain(1);
    for (int i = 0; i <= kRaster; ++i)
      for (int j = 0; j <= kRaster; ++j) {
        s.evaluate1(us[0] + (us[1] - us[0]) * i / kRaster, vs[0] + (vs[1] - vs[0]) * j / kRaster, E);
        best = std::min(best, (E.S - p).norm());
      }
  }
  return best;
}

void expectAsNearAsTraceFinds(const std::string& file, double tolerance) {
  const ModelFile model_file = readModelFile(kModels + file);
  const trace::Model other(model_file.surfaces);
  const Model model(samples::sheetOf(model_file.surfaces));
  std::vector<spline::Surface> surfaces;
  for (const auto& data : model_file.surfaces) surfaces.emplace_back(data);
  Tracer tracer(model);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(-0.2, 1.2);
  const Vector3d size = model.bounds().sizes();
  trace::Found found;
  int proved = 0, queries = 0;
  double worse = 0, better = 0;
  for (; queries < 3000; ++queries) {
    const Vector3d p = model.bounds().min() + Vector3d(share(random), share(random), share(random)).cwiseProduct(size);
    const contact::Foot foot = tracer.nearest(p);
    other.search(p, 1, found);
    proved += foot.status == contact::FootStatus::kNearest;
    const double excess = foot.distance - found.nearest[0].distance;
    worse = std::max(worse, excess);
    better = std::max(better, -excess);
    ASSERT_LE(excess, tolerance) << file << " " << p.transpose();
    ASSERT_LE(foot.distance, denseDistance(surfaces, p) + 1e-12);
  }
  std::printf("%s: excess at most %.2g m, nearer by at most %.2g m, %.1f %% proved\n", file.c_str(), worse, better,
              100.0 * proved / queries);
  EXPECT_GT(proved, 0.7 * queries);  // probes far inside, near centres of curvature, are not proved
}

TEST(SplineFeet, OfTheTeapot) {
  expectAsNearAsTraceFinds("teapot.yaml", 1e-10);
}
TEST(SplineFeet, OfTheGoblet) {
  expectAsNearAsTraceFinds("goblet.yaml", 1e-10);
}
TEST(SplineFeet, OfTheTorus) {
  expectAsNearAsTraceFinds("torus.yaml", 1e-10);
}
TEST(SplineFeet, OfTheSphere) {
  expectAsNearAsTraceFinds("sphere.yaml", 1e-10);
}

TEST(TableCurves, EvaluateAsTheCurvesThatTheyCopy) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-0.1, 1.1);
  TableCurves tables;
  std::vector<spline::Curve> curves;
  for (int k = 0; k < 24; ++k) {
    const int degree = 1 + k % 7, spans = 1 + k % 4;
    spline::CurveData data;
    data.degree = degree;
    data.knots.assign(static_cast<std::size_t>(degree + 1), 0.0);
    for (int i = 1; i <= spans; ++i)
      data.knots.insert(data.knots.end(), i < spans ? 1u : static_cast<std::size_t>(degree + 1), 1.0 * i / spans);
    for (int i = 0; i < degree + spans; ++i) {
      data.points.emplace_back(i + share(random), share(random), share(random));
      if (k % 2 == 1) data.weights.push_back(1 + 0.1 * share(random));
    }
    curves.emplace_back(data, spline::Form::kTable);
    ASSERT_EQ(tables.add(curves.back()), curves.size() - 1);
  }
  for (std::uint32_t k = 0; k < curves.size(); ++k) {
    const auto breaks = curves[k].breaks();
    EXPECT_EQ(tables.breaks(k), std::vector<double>(breaks.begin(), breaks.end()));
    for (int i = 0; i < 200; ++i) {
      const double t = i == 0 ? 0 : i == 1 ? 1 : i == 2 ? std::nan("") : i % 3 == 0 ? 0.25 * (i % 5) : share(random);
      spline::CurvePoint ours, theirs;
      ours.span = i % 9 - 2;
      tables.evaluate2(k, t, ours);
      curves[k].evaluate2(t, theirs);
      ASSERT_TRUE(ours.C == theirs.C && ours.C1 == theirs.C1 && ours.C2 == theirs.C2 && ours.span == theirs.span)
          << k << ' ' << t;
    }
  }
}

/// The first leaves that a search examines may all have their feet outside the trim. Then it must go on, because a part
/// without a foot is not felt at all.
TEST(SplineParts, ASearchThatHasFoundNothingGoesOn) {
  constexpr int kFew = 4;
  const Model model(samples::sheetOf(readModelFile(kModels + "goblet.yaml").surfaces));
  Search search(model);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(-0.2, 1.2);
  for (int i = 0; i < 3000; ++i) {
    const Vector3d p = model.bounds().min() +
                       Vector3d(share(random), share(random), share(random)).cwiseProduct(model.bounds().sizes());
    search.reset();
    const SearchBudget budget{2048, kFew};
    ASSERT_TRUE(search.nearest(p, budget).found()) << p.transpose();
  }
}

}  // namespace
}  // namespace hapticd::brep
