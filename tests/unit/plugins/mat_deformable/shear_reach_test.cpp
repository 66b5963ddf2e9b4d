// SPDX-License-Identifier: MIT
/// `shear_reach` of a file: how far beside a press the surface goes down with it.
#include <random>

#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

constexpr double kSpacing = 5e-3, kStiffness = 200;
constexpr int kPoints = 13;

/// A plate of 13 x 13 points, 5 mm apart.
std::string plate(double reach) {
  std::string text = "format: hapticd-model/2\nmedial:\n  points:\n";
  for (int i = 0; i < kPoints; ++i) {
    text += "    - [";
    for (int j = 0; j < kPoints; ++j)
      text += (j > 0 ? ", [" : "[") + std::to_string(kSpacing * (i - kPoints / 2)) + ", " +
              std::to_string(kSpacing * (j - kPoints / 2)) + ", 0]";
    text += "]\n";
  }
  return text +
         "  radius: 0.01\n  stiffness: 200\n  damping: 0.5\n  mass: 0.01\n  shear_reach: " + std::to_string(reach) +
         "\n";
}

class Plate : public Plugin {
 public:
  explicit Plate(const std::string& file, uint32_t probes = 1) : Plugin(file) {
    EXPECT_EQ(activate(probes), HSP_OK);
    for (uint32_t i = 0; i < probes; ++i) search({0, 0, .03}, i);
  }
};

Vector3d above(double x, double y, double depth) {
  return {x, y, .01 - depth};
}

/// Share of the depth of one press by which the surface beside it goes down: two probes share what the one does not
/// get.
double dentBeside(const std::string& file, double aside) {
  constexpr double kDepth = 1e-3;
  Plate body(file, 2);
  std::vector<hsp_contact> felt;
  for (int i = 0; i < 3000; ++i)
    felt = body.step(
        {above(.001, .002, std::min(1e-5 * i, kDepth)), above(.001 + aside, .002, std::min(1e-5 * i, kDepth))});
  return (kDepth - felt[1].force[2] / kStiffness) * kStiffness / felt[0].force[2];
}

TEST(ShearReach, WidensTheDentAndLeavesThePress) {
  const TemporaryFile narrow("narrow.yaml", plate(0)), wide("wide.yaml", plate(2.7e-3));
  for (const double aside : {6e-3, 7.5e-3, 10e-3}) {
    // Twice the cubic B-spline of the points (variance h^2 / 3), and of the reach (L^2 / 2). The contact spring, three
    // times as stiff as the body, takes a third of the depth.
    const auto gauss = [aside](double reach) {
      return 2.0 / 3 * std::exp(-.5 * aside * aside / (2 * kSpacing * kSpacing / 3 + reach * reach));
    };
    EXPECT_NEAR(dentBeside(narrow.path(), aside), gauss(0), .03);
    EXPECT_NEAR(dentBeside(wide.path(), aside), gauss(2.7e-3), .03);
  }
  for (const auto& [x, y] : {std::pair(.001, .002), std::pair(.029, .0), std::pair(.028, -.029)}) {
    Plate body(wide.path());
    for (int i = 0; i < 3000; ++i) body.touch(above(x, y, std::min(1e-5 * i, 2e-3)));
    EXPECT_NEAR(forceOf(body.touch(above(x, y, 2e-3))).z(), kStiffness * 2e-3, 1e-9) << x << " " << y;
  }
}

TEST(ShearReach, RandomMotionsMakeNoEnergy) {
  std::mt19937 engine(11);
  std::normal_distribution<double> normal;
  for (const double reach : {2e-3, 7e-3, 1e3}) {  // the last is cut to what a place may hold
    const TemporaryFile file("reach.yaml", plate(reach));
    Plate body(file.path());
    Vector3d p(.02, .02, .0101), velocity = Vector3d::Zero(), before = Vector3d::Zero();
    const Vector3d home = p;
    double worked = 0, turned_over = 0;
    body.touch(p);
    const int count = motions(10'000);
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k) velocity[k] += .01 * normal(engine);
      velocity -= .02 * velocity + 2 * (p - (home - Vector3d(0, 0, .003)));
      const Vector3d next = p + 1e-3 * velocity;
      const Vector3d force = forceOf(body.touch(next));
      worked -= .5 * (force + before).dot(next - p);
      turned_over = std::max(turned_over, std::fabs(worked));
      ASSERT_GT(worked, -1e-3 * turned_over - 1e-8) << reach << " " << i;
      p = next;
      before = force;
    }
    EXPECT_GT(turned_over, 1e-4);
  }
}

TEST(ShearReach, IsALengthOfAGrid) {
  const TemporaryFile wrong("wrong.yaml", plate(-1));
  Plugin body(wrong.path());
  EXPECT_LT(body.activate(), 0);
}

}  // namespace
}  // namespace hapticd::test
