// SPDX-License-Identifier: MIT
/// A shape of the wrong sign is silenced while its force is small, and no shape of the right sign ever is.
#include "servo/safety/pull.hpp"

#include <cmath>
#include <functional>

#include "test_world.hpp"

namespace hapticd::servo {
namespace {

constexpr double kDt = 1e-3;

/// A floor at y = 0 whose force along y is a function of depth; the probe stands at a height and an x.
struct Floor {
  std::function<double(double)> force;
  double normal = 1, claim = 800;
  Pull pull;
  bool at(double y, double x = 0) {
    hsp_contact out{};
    out.depth_m = -y;
    out.normal[1] = normal;
    out.flags = HSP_OUT_TRACED | (out.depth_m > 0 ? uint32_t{HSP_OUT_CONTACT} : 0u);
    out.force[1] = out.depth_m > 0 ? force(out.depth_m) : 0;
    return pull.judge(hsp_probe{}, out, {x, y, 0}, claim);
  }
};

/// The force with which the shape drew the hand when it was found out, on the way down at a speed; NaN: it never was.
double foundAt(Floor floor, double speed) {
  for (double y = 1e-3; y > -0.03; y -= speed * kDt)
    if (floor.at(y)) return std::abs(floor.force(-y));
  return std::nan("");
}

TEST(Pull, AForceOfTheWrongSignIsFoundWhileItIsSmall) {
  for (const double k : {100.0, 800.0, 5000.0})
    for (const double speed : {0.01, 0.1, 0.3})
      for (const double normal : {1.0, -1.0}) {
        const Floor floor{[k](double depth) { return -k * depth; }, normal, k, {}};
        EXPECT_LT(foundAt(floor, speed), std::sqrt(2 * k * Pull::kEnergy) + 4 * k * speed * kDt)
            << k << " N/m at " << speed << " m/s";
      }
}

TEST(Pull, ADepthThatGrowsOutwardIsFound) {
  Pull pull;
  bool found = false;
  for (int i = 0; i < 300 && !found; ++i) {
    hsp_contact out{};
    const double y = 1e-4 * i;
    out.depth_m = y, out.normal[1] = 1, out.force[1] = 800 * y;
    out.flags = HSP_OUT_TRACED | HSP_OUT_CONTACT;
    found = pull.judge(hsp_probe{}, out, {0, y, 0}, 800);
  }
  EXPECT_TRUE(found);
}

TEST(Pull, SpringsDetentsAndDampersAreNoPull) {
  const std::function<double(double)> laws[] = {
      [](double d) { return 2000 * d; },
      [](double d) { return 4e5 * d * d; },
      [](double d) { return d < 2e-3   ? 3000 * d
                            : d < 4e-3 ? 6 - 4000 * (d - 2e-3)
                                       : -2 + 3000 * (d - 4e-3); },
  };
  for (const auto& law : laws) {
    Floor floor{law, 1, 3000, {}};
    for (int i = 0; i < 20000; ++i) {
      // presses, holds in the detent with a tremor, and slides, at every speed
      const double y =
          1e-3 - 6e-3 * (0.5 - 0.5 * std::cos(i * 1e-3 * (1 + i % 5000 * 1e-3))) + 2e-4 * std::sin(i * 0.3);
      ASSERT_FALSE(floor.at(y, 0.01 * std::sin(i * 0.01))) << i;
    }
  }
}

TEST(Pull, AContactThatBeginsInADetentMayGiveWhatItHolds) {
  Floor floor{[](double d) { return d < 4e-3 ? 6 - 2000 * d : -2.0; }, 1, 3000, {}};
  for (double y = -3.2e-3; y > -4.8e-3; y -= 1e-5) ASSERT_FALSE(floor.at(y)) << y;
}

TEST(Pull, TheCoreSilencesTheShape) {
  scene::Scene scene;
  scene.models.push_back(testModel("pulling"));
  auto world = testWorld(scene);
  double most = 0;
  int i = 0;
  for (; i < 100; ++i) {
    const Vector3d force = tickOnce(*world, i, probeAt({0, 1e-3 - 1e-4 * i, 0}));
    most = std::max(most, -force.y());
  }
  EXPECT_EQ(world->core().models()[0].guard.trouble(), Trouble::kPull);
  EXPECT_LT(most, 1.5);  // 9 mm deep at the end: 9 N without the guard
  EXPECT_EQ(tickOnce(*world, i, probeAt({0, -9e-3, 0})).norm(), 0);
}

}  // namespace
}  // namespace hapticd::servo
