// SPDX-License-Identifier: MIT
/// What is answered coarser when a tick is too short, in which order, and when accuracy comes back. Costs are counted,
/// never measured.
#include "servo/core/load_shedding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hapticd::servo {
namespace {

/// Shapes whose steps cost less at each level, and a budget.
struct Tick {
  std::vector<Load> loads;
  std::vector<uint64_t> full;  ///< [ns] at level 0
  LoadShedding balance;
  int changes = 0;

  void add(double importance, uint64_t full_ns) {
    loads.push_back({static_cast<uint32_t>(loads.size()), 0, full_ns, 0, importance});
    full.push_back(full_ns);
  }
  uint64_t spent() const {
    uint64_t sum = 0;
    for (const Load& load : loads) sum += load.step_ns;
    return sum;
  }
  void run(int ticks, uint64_t budget_ns) {
    for (int i = 0; i < ticks; ++i) {
      for (const auto& change : balance.findChanges(loads, budget_ns)) {
        Load& load = loads[change.model];
        if (change.level > load.level) load.finer_ns = load.step_ns;
        load.level = change.level;
        ++changes;
      }
      for (Load& load : loads) load.step_ns = full[load.model] >> load.level;
    }
  }
};

TEST(LoadShedding, LeavesATickAloneThatFits) {
  Tick tick;
  for (int i = 0; i < 10; ++i) tick.add(-0.01 * i, 1000);
  tick.run(1000, 10'000);
  EXPECT_EQ(tick.changes, 0);
}

TEST(LoadShedding, LowersTheLeastImportantFirstAndContactLast) {
  Tick tick;
  tick.add(0.002, 1000);  // in contact
  for (int i = 1; i < 10; ++i) tick.add(-0.01 * i, 1000);
  tick.run(50, 7'000);
  EXPECT_LE(tick.spent(), 7'000u);
  EXPECT_EQ(tick.loads[0].level, 0u);
  for (size_t i = 1; i < tick.loads.size(); ++i) EXPECT_GE(tick.loads[i].level, tick.loads[i - 1].level) << i;
  tick.run(100, 500);  // nothing is left but the contact
  EXPECT_EQ(tick.loads[0].level, Accuracy::kCoarsest);
}

TEST(LoadShedding, CountsWhatIsNotTracedForLeastImportant) {
  Tick tick;
  tick.add(-HUGE_VAL, 1000);
  tick.add(-0.5, 1000);
  tick.run(1, 1'500);
  EXPECT_EQ(tick.loads[0].level, 1u);
  EXPECT_EQ(tick.loads[1].level, 0u);
}

TEST(LoadShedding, LowersAShapeAtOnceThatTakesMoreThanAllMay) {
  Tick tick;
  tick.add(-0.002, 50'000);
  tick.add(-0.1, 100);
  tick.run(1, 10'000);
  EXPECT_EQ(tick.loads[0].level, Accuracy::kCoarsest);
}

TEST(LoadShedding, GivesAccuracyBackWhenTheLoadFalls) {
  Tick tick;
  tick.add(0.002, 1000);
  for (int i = 1; i < 10; ++i) tick.add(-0.01 * i, 1000);
  tick.run(100, 5'000);
  for (size_t i = 5; i < 10; ++i) tick.full[i] = 1;  // the probe went away from half of them
  tick.run(200'000, 8'000);
  for (const Load& load : tick.loads) EXPECT_EQ(load.level, 0u) << load.model;
}

TEST(LoadShedding, DoesNotFlapUnderASteadyLoad) {
  Tick tick;
  tick.add(0.002, 1000);
  for (int i = 1; i < 10; ++i) tick.add(-0.01 * i, 1000);
  tick.run(1000, 7'000);
  const int settled = tick.changes;
  tick.run(100'000, 7'000);  // ten seconds at 10 kHz
  EXPECT_LE(tick.changes - settled, 12) << "accuracy changes under a load that does not";
}

TEST(LoadShedding, BelievesASpikeNoLongerThanItLasts) {
  Tick tick;
  for (int i = 0; i < 5; ++i) tick.add(-0.01 * i, 1000);
  tick.loads[3].step_ns = 30'000;  // once
  tick.run(1, 10'000);
  EXPECT_EQ(tick.loads[3].level, Accuracy::kCoarsest);
  tick.run(100'000, 10'000);
  EXPECT_EQ(tick.loads[3].level, 0u);
}

TEST(LoadShedding, LeavesWhatIsTouchedAloneThroughASpike) {
  Tick tick;
  tick.add(0.002, 1000);
  tick.add(-0.1, 1000);
  for (int spikes = 0; spikes < 100; ++spikes) {
    tick.loads[0].step_ns = 50'000;
    tick.run(5, 10'000);
  }
  EXPECT_EQ(tick.loads[0].level, 0u);
  tick.full[0] = 50'000;  // now it lasts
  tick.run(30, 10'000);
  EXPECT_EQ(tick.loads[0].level, Accuracy::kCoarsest);
}

TEST(LoadShedding, AsksShapesForLessLevelByLevel) {
  EXPECT_EQ(Accuracy::of(0).max_iterations, 0u);
  EXPECT_EQ(Accuracy::of(0).order, 0u);
  for (uint32_t level = 2; level <= Accuracy::kCoarsest; ++level)
    EXPECT_LT(Accuracy::of(level).max_iterations, Accuracy::of(level - 1).max_iterations);
  EXPECT_GE(Accuracy::of(Accuracy::kCoarsest).max_iterations, 1u) << "a shape in contact is never left out";
}

}  // namespace
}  // namespace hapticd::servo
