// SPDX-License-Identifier: MIT
/// config/scenes/overload.yaml, where every evaluation is taken to cost so much: the servo keeps its budget by lowering
/// accuracy, the same way every time, and the shape that is touched stays exact.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "scene/load.hpp"
#include "servo/loop/lockstep.hpp"
#include "world/world.hpp"

namespace hapticd::servo {
namespace {

void noLog(int, const std::string&, const std::string&) {}

struct Overload {
  explicit Overload(double evaluation_ns) {
    host::Catalog catalog(host::SearchPath::standard());
    scene::Loaded loaded = scene::load(HAPTICD_SOURCE_DIR "/config/scenes/overload.yaml", catalog, {true, ""});
    EXPECT_TRUE(loaded.scene);
    scene = *loaded.scene;
    WorldOptions options{.rate = scene.servo.rate, .measure = true, .budgets = true};
    options.evaluation_ns = evaluation_ns;
    auto built = World::build(scene, options, noLog);
    EXPECT_TRUE(built) << (built ? "" : built.error());
    world = std::move(*built);
    lockstep = std::make_unique<Lockstep>(world->lockstep());
  }

  /// Strokes the sphere 2 mm deep.
  void tick() {
    const double rate = scene.servo.rate, t = count / rate, dt = count == 0 ? 0 : 1 / rate;
    const double a = 0.9 * std::sin(2 * t);
    Probe probe;
    probe.valid = true;
    probe.position = 0.048 * Vector3d(std::sin(a), 0, std::cos(a));
    changes += static_cast<int>(world->core().shedLoad().size());
    world->core().publish(t, {&probe, 1});
    lockstep->before(t);
    world->core().tick(t, dt, {&probe, 1});
    ++count;
    touched += world->core().contact(0, 0).world.depth_m > 0;
    forces.push_back(world->core().force(0).norm());
    uint64_t ns = 0;
    for (const ModelState& model : world->core().models()) ns += model.step_ns;
    late += static_cast<double>(ns) > scene.servo.budget_us * 1e3;
  }
  void run(int ticks) {
    late = changes = 0;
    for (int i = 0; i < ticks; ++i) tick();
  }
  const ModelState& model(size_t i) const { return world->core().models()[i]; }
  double worstLevel() const {
    uint32_t worst = 0;
    for (const ModelState& m : world->core().models()) worst = std::max(worst, m.level);
    return worst;
  }

  scene::Scene scene;
  std::unique_ptr<World> world;
  std::unique_ptr<Lockstep> lockstep;
  std::vector<double> forces;
  int count = 0, touched = 0, late = 0, changes = 0;
};

constexpr double kDear = 600, kCheap = 10;  ///< [ns] an evaluation

TEST(Overload, LowersTheFarOnesKeepsTheDeadlineAndLosesNoContact) {
  Overload dear(kDear);
  dear.run(4000);  // settles
  EXPECT_GT(dear.worstLevel(), 0);
  dear.run(10'000);
  EXPECT_LT(dear.late, 500) << "of 10,000 ticks are beyond the budget still";
  EXPECT_EQ(dear.touched, dear.count) << "a shape in contact was dropped";
  EXPECT_EQ(dear.model(0).coarsest, 0u) << "the shape in contact was answered coarser";
  uint64_t degraded = 0;
  for (const ModelState& model : dear.world->core().models()) {
    degraded += model.degraded_ticks;
    EXPECT_TRUE(model.level == 0 || model.status == HSP_DEGRADED)
        << model.shape->name() << " level " << model.level << " answers " << model.status;
  }
  EXPECT_GT(degraded, 0u);
}

TEST(Overload, IsNoneWhereTheBudgetHolds) {
  Overload cheap(kCheap);
  cheap.run(3000);
  EXPECT_EQ(cheap.late, 0);
  EXPECT_EQ(cheap.worstLevel(), 0);
}

TEST(Overload, FeelsTheSameWhereTheTouchedShapeStaysExact) {
  Overload dear(kDear), cheap(kCheap);
  dear.run(3000);
  cheap.run(3000);
  for (size_t i = 0; i < dear.forces.size(); ++i)
    ASSERT_NEAR(dear.forces[i], cheap.forces[i], 1e-9) << "at tick " << i << " the hand felt that others were coarser";
}

TEST(Overload, IsAnsweredTheSameWayEveryTime) {
  Overload a(kDear), b(kDear);
  a.run(3000);
  b.run(3000);
  EXPECT_EQ(a.changes, b.changes);
  for (size_t i = 0; i < a.world->core().models().size(); ++i)
    EXPECT_EQ(a.model(i).degraded_ticks, b.model(i).degraded_ticks) << i;
}

}  // namespace
}  // namespace hapticd::servo
