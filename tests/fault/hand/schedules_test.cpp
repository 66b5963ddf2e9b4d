// SPDX-License-Identifier: MIT
/// Schedules of random faults in virtual time: the force never grows after a fault, none is left on, and nobody else is
/// blamed. HAPTICD_SCHEDULES says how many; a batch of them shares one arm and ends with a plugin that fails.
#include <cmath>
#include <cstdlib>
#include <random>
#include <set>

#include "scenario.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

constexpr int kTicks = 130;  ///< of a schedule: the force ramps in, faults, all is well, silence, cleared
constexpr int kWellAt = 95, kLookAt = 120, kBatch = 40;
constexpr int kPluginFaults = 5;
const ShapeFault kBlamed[] = {ShapeFault::kNone, ShapeFault::kNotFinite, ShapeFault::kBadStatus,
                              ShapeFault::kLost, ShapeFault::kJump,      ShapeFault::kNotUnit};

enum Kind { kLost, kAtFault, kQuiet, kWriteFails, kNotANumber, kJumps, kTooFast, kOrientation, kLate, kHold, kKinds };

/// The faults that a kind may be named by.
std::set<Fault> namesOf(Kind kind) {
  switch (kind) {
    case kLost:
    case kWriteFails:
      return {Fault::kDeviceLost};
    case kAtFault:
      return {Fault::kDeviceFault};
    case kQuiet:
      return {Fault::kStale};
    case kNotANumber:
      return {Fault::kNotFinite};
    case kJumps:
      return {Fault::kJumped, Fault::kTooFast};
    case kTooFast:
      return {Fault::kTooFast};
    case kOrientation:
      return {Fault::kNotUnit};
    case kLate:
      return {Fault::kLate};
    default:
      return {Fault::kStopped};
  }
}

struct Planned {
  Kind kind;
  int from, to;  ///< [ticks] of the schedule
};

/// Plays schedules on an arm, and looks after each tick what the motors do.
class Player {
 public:
  Player(Scenario& scenario, uint64_t seed, int schedules)
      : scenario_(scenario), random_(seed), schedules_(schedules) {}

  Nanoseconds before(double) {
    if (tick_ > 0) look();
    const int now = tick_++ % kTicks;
    Nanoseconds late = 0;
    rig::Wishes& wishes = scenario_.wishes();
    wishes.faults = 0;
    wishes.orientation[0] = 1;
    scenario_.moveTo(Vector3d::Zero());
    if (played_ >= schedules_) return 0;
    if (now == 0) plan();
    for (const Planned& p : plan_)
      if (now >= p.from && now < p.to) late = std::max(late, inject(p.kind, now == p.from, wishes));
    if (now == kLookAt && scenario_.fault() == Fault::kNone) ++unharmed;
    if (now == kLookAt) clear();
    if (now == kTicks - 1) ++played_;
    return late;
  }

  uint64_t faults = 0, unharmed = 0, grown = 0, left_on = 0, misnamed = 0, kinds[kKinds] = {};

 private:
  int any(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

  void plan() {
    plan_.clear();
    allowed_.clear();
    for (int i = any(1, 3); i > 0; --i) {
      const int from = any(30, 60);
      plan_.push_back({static_cast<Kind>(any(0, kKinds - 1)), from, std::min(kWellAt, from + any(1, 60))});
      for (const Fault fault : namesOf(plan_.back().kind)) allowed_.insert(fault);
      ++kinds[plan_.back().kind];
    }
  }

  Nanoseconds inject(Kind kind, bool first, rig::Wishes& wishes) {
    constexpr uint32_t kBits[] = {rig::kLost, rig::kHardwareFault, rig::kSilent, rig::kWriteFails};
    if (kind <= kWriteFails) wishes.faults = wishes.faults.load() | kBits[kind];
    if (kind == kNotANumber) wishes.position[0] = std::nan("");
    if (kind == kJumps) wishes.position[0] = 0.1;
    if (kind == kTooFast) wishes.position[1] = 0.008;
    if (kind == kOrientation) wishes.orientation[0] = 1.1;
    if (kind == kHold && first) order(Order::Kind::kHold);
    return kind == kLate && first ? 150'000'000 : 0;
  }

  void order(Order::Kind kind) {
    Order order;
    order.kind = kind;
    scenario_.loop().post(order);
  }

  /// Of each fault once the schedule is over: silence, a name that fits, and an end by the user's order.
  void clear() {
    if (scenario_.motorsOn() && scenario_.fault() != Fault::kNone) ++left_on;
    order(Order::Kind::kClear);
    last_ = HUGE_VAL;
    latched_ = false;
  }

  void look() {
    const double force = scenario_.motorForce();
    const Fault fault = scenario_.fault();
    if (fault != Fault::kNone && !latched_) {
      ++faults;
      latched_ = true;
      since_ = tick_;
      if (played_ < schedules_ && allowed_.count(fault) == 0) ++misnamed;  // then the run ends
    }
    if (latched_ && force > last_ * (1 + 1e-12)) ++grown;
    // The fault's own tick is in it; a planned end takes 20 ms.
    if (latched_ && tick_ - since_ > 21 && fault != Fault::kNone && force > 0) ++left_on;
    if (fault == Fault::kNone) latched_ = false;
    last_ = force;
  }

  Scenario& scenario_;
  std::mt19937_64 random_;
  int schedules_, played_ = 0, tick_ = 0, since_ = 0;
  std::vector<Planned> plan_;
  std::set<Fault> allowed_;
  double last_ = HUGE_VAL;
  bool latched_ = false;
};

int wanted() {
  const char* asked = std::getenv("HAPTICD_SCHEDULES");
  return asked != nullptr ? std::atoi(asked) : 8000;
}

TEST(Schedules, OfRandomFaultsLeaveNoForceOnAndBlameNoInnocent) {
  uint64_t faults = 0, unharmed = 0, kinds[kKinds] = {};
  int batch = 0;
  for (int left = wanted(); left > 0; left -= kBatch, ++batch) {
    const int schedules = std::min(left, kBatch), how = batch % (kPluginFaults + 1);
    const double seconds = schedules * kTicks * 1e-3 + 5;  // late ticks take their time, and the plugin fails after all
    auto failing = hostile("failing", {value(0, HSP_ENUM, how), value(1, HSP_INT, schedules * kTicks + 50)});
    auto innocent = hostile("failing", {value(0, HSP_ENUM, 0)});
    innocent.name = "innocent";
    Scenario scenario({.models = {failing, innocent}});
    Player player(scenario, 1000 + static_cast<uint64_t>(batch), schedules);
    scenario.run(seconds, [&](double t) { return player.before(t); });
    ASSERT_EQ(player.grown, 0u) << "batch " << batch;
    ASSERT_EQ(player.left_on, 0u) << "batch " << batch;
    ASSERT_EQ(player.misnamed, 0u) << "batch " << batch;
    ASSERT_EQ(scenario.trouble(0), kBlamed[how]) << "batch " << batch;
    ASSERT_EQ(scenario.trouble(1), ShapeFault::kNone) << "batch " << batch;
    ASSERT_FALSE(scenario.motorsOn()) << "after the end, batch " << batch;
    faults += player.faults, unharmed += player.unharmed;
    for (int i = 0; i < kKinds; ++i) kinds[i] += player.kinds[i];
  }
  std::printf("%d schedules: %llu faults latched, %llu schedules without one\n", wanted(),
              static_cast<unsigned long long>(faults), static_cast<unsigned long long>(unharmed));
  EXPECT_GT(faults, static_cast<uint64_t>(wanted()) / 2) << "few faults: no test";
  for (int i = 0; i < kKinds; ++i) EXPECT_GT(kinds[i], 0u) << "kind " << i;
}

}  // namespace
}  // namespace hapticd::servo
