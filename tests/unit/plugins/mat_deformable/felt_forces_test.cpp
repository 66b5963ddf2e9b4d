// SPDX-License-Identifier: MIT
/// Forces of felt bodies on recorded motions: whatever makes a tick cheaper, the hand feels the same.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

constexpr int kTicks = 4000, kEvery = 20;
constexpr double kSame = 1e-9;  ///< [N]

/// From far above the body into its upper side and away again, wandering over it.
Vector3d placeAt(int tick, const Vector3d& low, const Vector3d& high) {
  const double wave = std::sin(2 * M_PI * 0.8e-3 * tick);
  const Vector3d at(0.25 * std::sin(2 * M_PI * 0.31e-3 * tick), 0.25 * std::sin(1 + 2 * M_PI * 0.23e-3 * tick),
                    0.6 + 0.4 * wave);
  return 0.5 * (low + high) + 0.5 * (high - low).cwiseProduct(at) + Vector3d(0, 0, 0.02 * (1 + wave));
}

struct Moment {
  int tick;
  Vector3d force;
};

std::vector<Moment> feel(const std::string& model) {
  constexpr int kFelt = 3;
  Plugin plugin(model + ".yaml");
  plugin.set("dynamics", kFelt);
  EXPECT_EQ(plugin.activate(), HSP_OK);
  Vector3d low, high;
  plugin.extension<hsp_ext_geometry>(HSP_EXT_GEOMETRY).bounds(plugin.handle(), low.data(), high.data());
  plugin.search({0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), high.z() + 0.02});
  std::vector<Moment> all;
  for (int tick = 1; tick <= kTicks; ++tick) {
    const Vector3d force = forceOf(plugin.touch(placeAt(tick, low, high)));
    if (tick % kEvery == 0 && !force.isZero(0)) all.push_back({tick, force});
  }
  return all;
}

/// felt_forces.csv was written by a version that was compared with one that followed every foot to 1e-8 m, however far
std::map<std::string, std::vector<Moment>> recorded() {
  std::ifstream file(HAPTICD_SOURCE_DIR "/tests/unit/plugins/mat_deformable/felt_forces.csv");
  std::map<std::string, std::vector<Moment>> all;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    const std::size_t comma = line.find(',');
    std::istringstream rest(line.substr(comma + 1));
    Moment moment{};
    char between = 0;
    rest >> moment.tick;
    for (double& force : moment.force) rest >> between >> force;
    EXPECT_FALSE(rest.fail()) << line;
    all[line.substr(0, comma)].push_back(moment);
  }
  return all;
}

TEST(FeltForces, AreThoseOfBeforeOnRecordedMotions) {
  const auto before = recorded();
  EXPECT_EQ(before.size(), 5u);
  for (const auto& [model, moments] : before) {
    const std::vector<Moment> now = feel(model);
    ASSERT_EQ(now.size(), moments.size()) << model;
    for (std::size_t i = 0; i < now.size(); ++i) {
      ASSERT_EQ(now[i].tick, moments[i].tick) << model;
      ASSERT_LT((now[i].force - moments[i].force).norm(), kSame) << model << ", tick " << now[i].tick;
    }
  }
}

/// Far away, a foot is followed by one evaluation; what is told of the distance stays right.
TEST(FeltForces, AFarProbeIsToldItsDistance) {
  constexpr int kSeen = 2, kFelt = 3;
  for (const char* model : {"pebble.yaml", "loaf.yaml", "soft-plate.yaml"}) {
    Plugin felt(model), seen(model);
    felt.set("dynamics", kFelt);
    seen.set("dynamics", kSeen);
    ASSERT_EQ(felt.activate(), HSP_OK);
    ASSERT_EQ(seen.activate(), HSP_OK);
    Vector3d low, high;
    felt.extension<hsp_ext_geometry>(HSP_EXT_GEOMETRY).bounds(felt.handle(), low.data(), high.data());
    const Vector3d above(0, 0, 0.02);
    felt.search(placeAt(1, low, high) + above);
    seen.search(placeAt(1, low, high) + above);
    int evaluations = 0, evaluations_seen = 0;
    for (int tick = 1; tick <= kTicks; ++tick) {
      const hsp_contact far = felt.touch(placeAt(tick, low, high) + above);
      const hsp_contact exact = seen.touch(placeAt(tick, low, high) + above);
      ASSERT_NEAR(far.depth_m, exact.depth_m, 1e-7) << model << ", tick " << tick;
      evaluations += static_cast<int>(far.iterations), evaluations_seen += static_cast<int>(exact.iterations);
    }
    EXPECT_LT(evaluations, 0.7 * evaluations_seen) << model;
  }
}

}  // namespace
}  // namespace hapticd::test
