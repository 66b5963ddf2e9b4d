// SPDX-License-Identifier: MIT
/// Every fault of safety.md that an arm can have, brought about in a whole loop: it is named, the force is zero within
/// 20 ms of it and never larger on the way, and it stays so until somebody clears it.
#include <algorithm>
#include <cctype>
#include <thread>

#include "test_rig.hpp"

namespace hapticd::servo {
namespace {

constexpr double kFailsAt = 0.05, kTick = 1e-3;

enum Failure {
  kNone,
  kLost,
  kNotANumber,
  kSilent,
  kAtFault,
  kUncalibrated,
  kRandom,
  kMoves,
  kJumps,
  kReleased,
  kGravity,
  kOrientation
};

/// What is done to the arm, and what must come of it.
struct Injected {
  const char* name;
  int failure;
  Fault fault;             ///< kNone: the force goes by itself and comes back, as an enable switch does
  const char* words;       ///< of the message
  double noticed = kTick;  ///< [s] after kFailsAt
  double speed = 0;        ///< [m/s] for kMoves
  Nanoseconds late = 0;    ///< the tick at kFailsAt wakes so late
  Order::Kind order = Order::Kind::kClear;  ///< another: given at kFailsAt
  void (*limit)(scene::Limits&) = [](scene::Limits&) {};
};

const Injected kFaults[] = {
    {"device lost", kLost, Fault::kDeviceLost, "the device is lost"},
    {"not a number in the sample", kNotANumber, Fault::kNotFinite, "was not a number"},
    {"no new sample", kSilent, Fault::kStale, "sent no new sample (measured: 0.05", 0.052},
    {"device fault", kAtFault, Fault::kDeviceFault, "reports a hardware fault"},
    {"late tick", kNone, Fault::kLate, "in a row were missed (measured: 0.15", kTick, 0, 150'000'000},
    {"velocity guard", kMoves, Fault::kTooFast, "faster than limits.velocity (measured:", 0.011, 2, 0,
     Order::Kind::kClear, [](scene::Limits& limits) { limits.velocity = 1; }},
    {"beyond what the velocity is estimated from", kMoves, Fault::kTooFast, "faster than limits.velocity", 3 * kTick,
     30, 0, Order::Kind::kClear, [](scene::Limits& limits) { limits.velocity = 1; }},
    {"position jump", kJumps, Fault::kJumped, "jumped farther than a hand can move (measured: 150 m/s)"},
    {"hold", kNone, Fault::kStopped, "stopped by the user", 2 * kTick, 0, 0, Order::Kind::kHold},
    {"dead-man switch released", kReleased, Fault::kNone, "", kTick, 0, 0, Order::Kind::kClear,
     [](scene::Limits& limits) { limits.enable = {0, scene::EnableMode::kHold}; }},
    {"workspace left", kMoves, Fault::kNone, "", 0.02, 4.5, 0, Order::Kind::kClear,
     [](scene::Limits& limits) { limits.workspace = 0.05; }},
    {"not a number for the weight", kGravity, Fault::kNotFinite, "was not a number", 2 * kTick},
    {"not a number in the orientation", kOrientation, Fault::kNotFinite, "was not a number"},
};

/// What there is after each tick.
struct Seen {
  double t, force;
  Fault fault;
  bool enabled;
};

struct FaultyLoop {
  explicit FaultyLoop(const Injected& what) : injected(what) {
    seen.reserve(2000);
    const std::vector<scene::Value> device{number(4, HSP_BOOL, 1), number(5, HSP_REAL, what.speed),
                                           number(3, HSP_REAL, what.fault == Fault::kNone ? 0.3 : 1e9)};
    rig = std::make_unique<Rig>(
        what.failure, [this](Nanoseconds deadline) { return before(deadline); }, 700, "wall",
        std::vector<scene::Value>{}, std::vector<scene::Model>{}, device, what.limit);
    rig->loop->run();
  }
  /// Before a tick: what the last one left, and what is done in this one.
  Nanoseconds before(Nanoseconds deadline) {
    const double t = static_cast<double>(deadline) * kSecondsPerNanosecond;
    const Arm& arm = *rig->arms[0];
    if (deadline > 0) seen.push_back({t - kTick, arm.force().norm(), arm.limiter().fault(), arm.limiter().enabled()});
    if (deadline != 50'000'000) return 0;
    if (injected.order != Order::Kind::kClear) {
      Order order;
      order.kind = injected.order;
      rig->loop->post(order);
    }
    return injected.late;
  }
  const Injected& injected;
  std::vector<Seen> seen;
  std::unique_ptr<Rig> rig;
};

class LoopFault : public testing::TestWithParam<Injected> {};

TEST_P(LoopFault, EndsInZeroForceWithinTwentyMillisecondsNamedAndNeverLarger) {
  const Injected& injected = GetParam();
  const double since = kFailsAt + static_cast<double>(injected.late) * kSecondsPerNanosecond;
  const FaultyLoop loop(injected);
  double before = 0;
  bool was_there = false;
  for (const Seen& seen : loop.seen) {
    if (seen.t > 0.67 || (injected.fault == Fault::kNone && seen.t > 0.29))
      break;  // the end of the run or of the failure
    was_there |= seen.t < since && seen.force > 1.99;
    if (seen.t >= since + injected.noticed - kTick / 2) {
      EXPECT_EQ(seen.fault, injected.fault) << seen.t;
    }
    if (seen.t >= since - kTick / 2) {
      EXPECT_LE(seen.force, before * (1 + 1e-12)) << "raised at " << seen.t;
    }
    if (seen.t >= since + injected.noticed + 0.02 - kTick / 2) {
      EXPECT_EQ(seen.force, 0) << seen.t;
    }
    before = seen.force;
  }
  EXPECT_TRUE(was_there) << "nothing was pushed: no test";
  EXPECT_TRUE(loop.rig->log->only_numbers);
}

TEST_P(LoopFault, SaysWhatHappenedAndWhatWasMeasured) {
  const Injected& injected = GetParam();
  const FaultyLoop loop(injected);
  const Limiter& limiter = loop.rig->arms[0]->limiter();
  if (injected.failure == kReleased) {
    EXPECT_TRUE(std::any_of(loop.seen.begin(), loop.seen.end(), [](const Seen& seen) { return !seen.enabled; }));
    return;
  }
  if (injected.fault == Fault::kNone) {
    EXPECT_GT(limiter.clips().ticks[static_cast<size_t>(Limit::kWorkspace)], 0u);
    return;
  }
  const std::string text = faultMessage("arm", limiter.fault(), limiter.measured());
  EXPECT_NE(text.find(injected.words), std::string::npos) << text;
}

/// What was done by the daemon or its user is over when it is cleared and not before; what the device did, see the
/// tests of recovery.
TEST_P(LoopFault, StaysUntilItIsClearedAndThenRampsIn) {
  const Injected& injected = GetParam();
  if (injected.fault == Fault::kNone || endsByItself(injected.fault)) return;
  Rig* self = nullptr;
  std::vector<Seen> seen;
  seen.reserve(2000);
  const auto before = [&](Nanoseconds deadline) -> Nanoseconds {
    const double t = static_cast<double>(deadline) * kSecondsPerNanosecond;
    const Arm& arm = *self->arms[0];
    seen.push_back({t - kTick, arm.force().norm(), arm.limiter().fault(), arm.limiter().enabled()});
    Order order;
    order.kind = deadline == 50'000'000 ? injected.order : Order::Kind::kClear;
    const bool now = deadline == 500'000'000 || (deadline == 50'000'000 && order.kind != Order::Kind::kClear);
    if (now) self->loop->post(order);
    return deadline == 50'000'000 ? injected.late : 0;
  };
  Rig rig(injected.failure, before, 700, "wall", {}, {},
          {number(4, HSP_BOOL, 1), number(5, HSP_REAL, injected.speed), number(3, HSP_REAL, 0.3)}, injected.limit);
  self = &rig;
  rig.loop->run();
  double last = 0;
  for (const Seen& s : seen) {
    if (s.t > 0.4 && s.t < 0.4995) {
      EXPECT_EQ(s.fault, injected.fault) << s.t;
      EXPECT_EQ(s.force, 0) << s.t;
    }
    if (s.t > 0.5 && s.t < 0.6) {
      EXPECT_EQ(s.fault, Fault::kNone) << s.t;
      EXPECT_LE(s.force, last + 0.21) << "10 ms to 2 N";
    }
    if (s.t > 0.55 && s.t < 0.6) {
      EXPECT_NEAR(s.force, 2, 1e-9);
    }
    last = s.force;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, LoopFault, testing::ValuesIn(kFaults), [](const auto& given) {
  std::string name = given.param.name;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
});

/// What a device does to find its zero, or after it was plugged in again, is no jump: nothing pushed meanwhile.
TEST(Jump, WithoutAForceIsNoFault) {
  Rig rig(kJumps,
          [&rig](Nanoseconds deadline) {
            if (deadline == 20'000'000) rig.arms[0]->limiter().trip(Fault::kNotCalibrated);
            return Nanoseconds{0};
          },
          900, "wall", {}, {}, {number(4, HSP_BOOL, 1), number(3, HSP_REAL, 0.06)});
  rig.loop->run();
  EXPECT_EQ(rig.arms[0]->limiter().recovered(), Fault::kNotCalibrated);
  EXPECT_EQ(rig.arms[0]->limiter().fault(), Fault::kStopped) << "by the end of the run";
}

TEST(EnableSwitch, ReleasedAndPressedAgainTheForceRampsIn) {
  const FaultyLoop loop(kFaults[9]);
  double last = 0;
  for (const Seen& seen : loop.seen) {
    if (seen.t > 0.3 && seen.t < 0.6) {
      EXPECT_LE(seen.force, last + 0.21) << seen.t;
    }
    if (seen.t > 0.35 && seen.t < 0.6) {
      EXPECT_NEAR(seen.force, 2, 1e-9) << seen.t;
    }
    last = seen.force;
  }
}

TEST(EnableSwitch, AButtonHeldThroughALostReadSwitchesNothingOn) {
  Rig rig(
      kLost, [](Nanoseconds) { return 0; }, 700, "wall", {}, {}, {number(3, HSP_REAL, 0.06)},
      [](scene::Limits& limits) { limits.enable = {0, scene::EnableMode::kToggle}; });
  rig.loop->run();
  EXPECT_FALSE(rig.arms[0]->limiter().enabled());
}

/// In the tick in which the watchdog writes its zero force there is no sample, and the way to the next one is twice as
/// long: no damper may take that for twice the speed.
TEST(HeldTick, LeavesNoSpikeInTheVelocity) {
  constexpr double kSpeed = 0.5;
  scene::Device device;
  device.name = device.module = "gantry";
  device.library = TEST_DEVICE;
  device.parameters = {number(1, HSP_REAL, 0), number(2, HSP_ENUM, kMoves), number(5, HSP_REAL, kSpeed)};
  auto arm = Arm::open(device, scene::Servo{}, {1000, true}, [](int, const std::string&, const std::string&) {});
  ASSERT_TRUE(arm) << arm.error();
  ASSERT_TRUE((*arm)->start(0, Eigen::Vector3d(0, -9.81, 0)));
  auto* log = static_cast<GantryLog*>(
      const_cast<void*>((*arm)->device().description().extension((*arm)->device().handle(), "test.log")));
  for (int i = 0; i < 200; ++i) {
    std::thread watchdog;
    if (i == 100) {
      log->hold = 1;
      watchdog = std::thread([&] { (*arm)->cut(0.004); });
      while (log->hold != 2) std::this_thread::yield();
    }
    const Probe& probe = (*arm)->read(static_cast<Nanoseconds>(i) * 1'000'000, i == 0 ? 0 : 1e-3);
    EXPECT_EQ(probe.valid, i != 100);
    if (i > 50 && i < 100) {
      EXPECT_NEAR(probe.velocity.x(), kSpeed, 1e-9);
    }
    if (i > 100) {
      EXPECT_LE(probe.velocity.norm(), kSpeed * (1 + 1e-9)) << i;
    }
    if (!watchdog.joinable()) continue;
    log->hold = 0;
    watchdog.join();
  }
  EXPECT_NEAR((*arm)->probe().velocity.x(), kSpeed, 1e-9);
}

TEST(HeldTick, ACutBeforeTheWriteOfATickKeepsTheMotorsOff) {
  Rig rig(0);
  Arm& arm = *rig.arms[0];
  for (int i = 0; i < 60; ++i) {
    const auto now = static_cast<Nanoseconds>(i) * 1'000'000;
    ASSERT_TRUE(arm.read(now, i == 0 ? 0 : 1e-3).valid);
    if (i == 50) {
      ASSERT_EQ(rig.log->mode, static_cast<uint32_t>(HDV_TORQUE));
      arm.cut(0.004);
    }
    arm.write(now, 1e-3, {0, 1, 0}, {0, 0, 0});
    if (i >= 50) {
      EXPECT_EQ(rig.log->mode, static_cast<uint32_t>(HDV_OFF)) << i;
    }
  }
  EXPECT_EQ(arm.limiter().fault(), Fault::kStuck);
}

/// Ten ticks to a sample: the hand is as fast as it is, not ten times as fast in one tick and still in nine.
TEST(SlowDevice, GivesTheVelocityOfTheHand) {
  constexpr double kSpeed = 1.5;
  Rig rig(
      kMoves, [](Nanoseconds) { return Nanoseconds{0}; }, 1000, "wall", {}, {},
      {number(1, HSP_REAL, 0), number(4, HSP_BOOL, 1), number(5, HSP_REAL, kSpeed), number(6, HSP_INT, 10)},
      [](scene::Limits& limits) { limits.velocity = 1.6; });
  Arm& arm = *rig.arms[0];
  for (int i = 0; i < 1000; ++i) {
    const Probe& probe = arm.read(static_cast<Nanoseconds>(i) * 100'000, i == 0 ? 0 : 1e-4);
    ASSERT_TRUE(probe.valid);
    if (i > 100) {
      EXPECT_NEAR(probe.velocity.x(), kSpeed, 1e-9) << i;
    }
  }
  EXPECT_EQ(arm.limiter().fault(), Fault::kNone);
}

/// The arm measures at its own rate. What a tick sees was measured now shortly and now long before it.
TEST(DeviceOfItsOwnRate, GivesTheVelocityOfTheHand) {
  constexpr double kSpeed = 0.5;
  for (const double rate : {401.0, 667.0, 999.7, 1000.3, 1500.0, 4001.0}) {
    Rig rig(
        kMoves, [](Nanoseconds) { return Nanoseconds{0}; }, 1000, "wall", {}, {},
        {number(1, HSP_REAL, 0), number(4, HSP_BOOL, 1), number(5, HSP_REAL, kSpeed), number(7, HSP_REAL, rate)},
        [](scene::Limits& limits) { limits.velocity = 1; });
    Arm& arm = *rig.arms[0];
    for (int i = 0; i < 5000; ++i) {
      const Probe& probe = arm.read(static_cast<Nanoseconds>(i) * 1'000'000, i == 0 ? 0 : 1e-3);
      ASSERT_TRUE(probe.valid);
      if (i > 100) {
        ASSERT_NEAR(probe.velocity.x(), kSpeed, 1e-6) << rate << " Hz, tick " << i;
      }
    }
  }
}

}  // namespace
}  // namespace hapticd::servo
