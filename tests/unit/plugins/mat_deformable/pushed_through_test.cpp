// SPDX-License-Identifier: MIT
/// A probe that wanders through a felt mesh, in and out and beyond its middle.
#include <random>

#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

/// A probe that wanders in a box, some 50 um a tick.
class Wanderer {
 public:
  Wanderer(const Vector3d& low, const Vector3d& high, uint64_t seed)
      : middle_(0.5 * (low + high)), half_(0.5 * (high - low)), engine_(seed) {
    for (int i = 0; i < 3; ++i) p_[i] = middle_[i] + 1.1 * half_[i] * chance();
  }
  const Vector3d& next() {
    for (int i = 0; i < 3; ++i) {
      velocity_[i] += 0.0085 * chance() - 0.02 * velocity_[i];
      const double ahead = p_[i] + 1e-3 * velocity_[i];
      if (std::fabs(ahead - middle_[i]) > half_[i] + 0.004) {
        velocity_[i] = -velocity_[i];
      } else {
        p_[i] = ahead;
      }
    }
    return p_;
  }

 private:
  double chance() { return static_cast<double>(engine_() >> 11) * 0x1p-52 - 1; }  // -1 to 1
  Vector3d middle_, half_, p_{0, 0, 0}, velocity_{0, 0, 0};
  std::mt19937_64 engine_;
};

/// Ticks in which the force turned round: half a newton and more before and after.
int flips(uint64_t seed, double& most) {
  constexpr int kFelt = 3, kPushTicks = 150'000;
  constexpr double kForce = 0.5, kJump = 1;
  Plugin plugin("branch.ma");
  plugin.set("dynamics", kFelt);
  EXPECT_EQ(plugin.activate(), HSP_OK);
  Vector3d low, high;
  plugin.extension<hsp_ext_geometry>(HSP_EXT_GEOMETRY).bounds(plugin.handle(), low.data(), high.data());
  plugin.search(high);
  Wanderer wanderer(low, high, seed);
  Vector3d before = Vector3d::Zero();
  int count = 0;
  for (int i = 0; i < kPushTicks; ++i) {
    const Vector3d force = forceOf(plugin.touch(wanderer.next()));
    const bool felt = before.norm() > kForce && force.norm() > kForce;
    if (felt && before.dot(force) < 0 && (force - before).norm() > kJump) ++count;
    most = std::max(most, force.norm());
    before = force;
  }
  return count;
}

/// Beyond the middle of a branch, where the foot went over to the other part, the direction went with it: the force
/// turned round in one tick, by up to 10 N, and on a stiffer body by as much as the arm could give.
TEST(PushedThrough, AForceDoesNotTurnRoundWhereTheFootGoesToAnotherPart) {
  for (const uint64_t seed : {2u, 3u, 4u}) {
    double most = 0;
    EXPECT_EQ(flips(seed, most), 0) << "seed " << seed;
    EXPECT_GT(most, 2) << "it was not pressed";
  }
}

}  // namespace
}  // namespace hapticd::test
