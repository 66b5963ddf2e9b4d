// SPDX-License-Identifier: MIT
/// Compares ticks that examine only the gathered elements around the probe with searches of the whole part, on spline
/// surfaces.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "kernels/brep/search/near_places.hpp"
#include "kernels/brep/search/search.hpp"
#include "sample_splines.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

struct NearTally {
  std::int64_t ticks = 0, near_nodes = 0, whole_nodes = 0, proved = 0;
};

/// A probe that moves along the surface, sometimes outside and sometimes inside. It jumps to another place every 2000
/// ticks.
class OverSurface {
 public:
  explicit OverSurface(const Model& model) : model_(model), random_(29) {}

  const Vector3d& next(int tick, const Nearest& before) {
    const double step = std::array{1e-6, 5e-5, 1e-4, 3e-4, 1e-3}[static_cast<std::size_t>(tick / 2000 % 5)];
    if (tick % 2000 == 0) {
      const Eigen::AlignedBox3d box = model_.bounds();
      p_ = box.min() + Vector3d(share_(random_), share_(random_), share_(random_)).cwiseProduct(box.sizes());
      return p_;
    }
    way_ = 0.95 * way_ + 0.3 * Vector3d(normal_(random_), normal_(random_), normal_(random_));
    p_ += step * way_.normalized() + 0.02 * (before.hit.point - p_);
    return p_;
  }

 private:
  const Model& model_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> share_{-0.1, 1.1};
  Vector3d p_{0, 0, 0}, way_{0, 0, 0};
};

Part sheet(const std::string& file) {
  return samples::sheetOf(readModelFile(HAPTICD_SOURCE_DIR "/config/models/" + file).surfaces);
}

/// Returns the part with two copies of its last instance, rotated and shifted so that they overlap.
Part assembly(Part part) {
  const double size = Model(part).bounds().diagonal().norm(), c = std::cos(0.3), s = std::sin(0.3);
  for (const double far : {0.1, 0.2}) {
    Instance instance = part.instances.back();
    instance.pose = {c, -s, 0, far * size, s, c, 0, 0, 0, 0, 1, far * size};
    part.instances.push_back(instance);
  }
  return part;
}

/// Walks with two searches. The budget of the second is too small for gathered elements, so it always searches the
/// whole part.
NearTally walkBesideWhole(Part part, const std::string& file, int most_rows) {
  const Model model(std::move(part));
  const SearchBudget enough, whole{enough.nodes, most_rows};
  Search near(model), all(model);
  OverSurface probe(model);
  NearTally tally;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d& p = probe.next(i, near.last());
    const Nearest& found = near.nearest(p, enough);
    const Nearest& truth = all.nearest(p, whole);
    ++tally.ticks;
    // the two searches may have different feet, and the next search begins at the last foot
    if (!found.proved || !truth.proved) {
      near.reset();
      all.reset();
      continue;
    }
    ++tally.proved;
    tally.near_nodes += found.nodes;
    tally.whole_nodes += truth.nodes;
    EXPECT_EQ(found.place, truth.place) << file << ", tick " << i;
    EXPECT_EQ(found.hit.element.code, truth.hit.element.code) << file << ", tick " << i;
    EXPECT_EQ(found.hit.d2, truth.hit.d2) << file << ", tick " << i;
    EXPECT_TRUE(found.hit.point == truth.hit.point) << file << ", tick " << i;
    if (testing::Test::HasFailure()) break;
  }
  return tally;
}

void expectFewerBoxes(const NearTally& tally, const char* file) {
  std::printf("%s: %lld of %lld ticks proved by both, %.1f boxes of four a tick, %.1f of the whole\n", file,
              static_cast<long long>(tally.proved), static_cast<long long>(tally.ticks),
              static_cast<double>(tally.near_nodes) / static_cast<double>(tally.proved),
              static_cast<double>(tally.whole_nodes) / static_cast<double>(tally.proved));
  EXPECT_GT(tally.proved, 8 * tally.ticks / 10);
  EXPECT_LT(tally.near_nodes, tally.whole_nodes);
}

TEST(NearElements, ChangeNoBitOfAnyProvedAnswer) {
  for (const char* file : {"goblet.yaml", "torus.yaml", "teapot.yaml"})
    expectFewerBoxes(walkBesideWhole(sheet(file), file, NearElements::kMostRows), file);
}

TEST(NearElements, ChangeNoBitOfAnAssemblysAnswers) {
  for (const char* file : {"goblet.yaml", "torus.yaml", "teapot.yaml"})
    expectFewerBoxes(walkBesideWhole(assembly(sheet(file)), file, NearPlaces::kMostRows), file);
}

}  // namespace
}  // namespace hapticd::brep
