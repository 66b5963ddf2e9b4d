// SPDX-License-Identifier: MIT
/// Presses on shells when the host sheds load, so that a tick has one, two or four evaluations.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "hand.hpp"
#include "shapes.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;

/// Presses straight into a shell, from outside, at one of its points.
struct Press {
  Vector3d aim, way;  ///< the way of one tick [m]
  static constexpr int kTicks = 80;

  Vector3d at(int tick) const { return aim + (tick - kTicks / 2 + 0.37) * way; }
};

/// Makes 200 presses about a point of a shell whose outward direction there is `out`. None may be lost. In few of them
/// the contact may begin later than one tick after the probe has met the shell.
void expectFelt(const Model& model, const Vector3d& home, const Vector3d& out, const std::string& name) {
  for (const int most : {1, 2, 4})
    for (const double step : {1e-5, 1e-4, 5e-4}) {
      int lost = 0, late = 0;
      for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> any(-1, 1);
        const auto aside = [&] { return Vector3d(any(random), any(random), any(random)); };
        const Vector3d off = aside();
        const Press press{home + 0.5 * step * (off - off.dot(out) * out), step * (0.6 * aside() - out)};
        Hand hand{model};
        hand.options = holding(contact::Sides::kBoth);
        hand.options.max_evaluations = most;
        int begun = -1;
        double depth = 0;
        for (int tick = 0; tick < Press::kTicks; ++tick) {
          depth = hand.at(press.at(tick)).depth;
          if (depth > 0 && begun < 0) begun = tick;
        }
        lost += !(depth > 0);
        late += depth > 0 && begun > Press::kTicks / 2 + 1;
      }
      EXPECT_EQ(lost, 0) << name << ", " << most << " evaluations, " << step;
      EXPECT_LE(late, 5) << name << ", " << most << " evaluations, " << step;
    }
}

TEST(Held, AShellIsEnteredUnderLoad) {
  const double r = 0.05, half = r * std::sqrt(0.5);
  const Model sphere(readModelFile(HAPTICD_SOURCE_DIR "/config/models/sphere.yaml").surfaces);
  const Model dome({turned({{r, 0, 1}, {r, r, std::sqrt(0.5)}, {0, r, 1}})});
  const Model fold({flat({-r, -r / 2, -r}, {-r, -r / 2, r}, {0, 0, -r}), flat({0, 0, -r}, {0, 0, r}, {r, -r / 2, -r})});
  expectFelt(sphere, {0, r, 0}, {0, 1, 0}, "pole of a sphere");
  expectFelt(sphere, {0.6 * r, 0.8 * r, 0}, {0.6, 0.8, 0}, "sphere");
  expectFelt(dome, {0, r, 0}, {0, 1, 0}, "pole of a dome");
  expectFelt(dome, {0, half, half}, {0, half / r, half / r}, "seam of a dome");
  expectFelt(fold, {0, 0, 0}, {0, 1, 0}, "fold");
}

}  // namespace
}  // namespace hapticd::trace
