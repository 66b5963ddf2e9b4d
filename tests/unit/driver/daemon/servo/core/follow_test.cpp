// SPDX-License-Identifier: MIT
/// A led pose keeps its bounds whatever the leader says, does not lag behind an honest one, and comes to rest.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <limits>
#include <random>

#include "servo/core/pose_follower.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

hsp_pose poseAt(const Vector3d& position) {
  hsp_pose pose{};
  Eigen::Map<Vector3d>(pose.position) = position;
  pose.orientation[0] = 1;
  return pose;
}

hapticd_target targetAt(const Vector3d& position, const Vector3d& linear = Vector3d::Zero(), double time = 0) {
  hapticd_target target{};
  Eigen::Map<Vector3d>(target.position) = position;
  Eigen::Map<Vector3d>(target.linear) = linear;
  target.orientation[0] = 1;
  target.time = time;
  return target;
}

Vector3d position(const hsp_pose& pose) {
  return Vector3d(pose.position);
}

Quaterniond orientation(const hsp_pose& pose) {
  return {pose.orientation[0], pose.orientation[1], pose.orientation[2], pose.orientation[3]};
}

/// Steps a follower and judges every step by its bounds.
class WatchTarget {
 public:
  PoseFollower follow;
  hsp_pose pose = poseAt(Vector3d::Zero());
  double t = 0;

  WatchTarget() { follow.begin(pose); }
  void step(double dt) {
    const hsp_pose before = pose;
    t += dt;
    follow.step(t, dt, pose);
    const double slack = 1e-9;
    const Vector3d v(pose.linear), v_before(before.linear), w(pose.angular), w_before(before.angular);
    EXPECT_LE(v.norm(), PoseFollower::kMostSpeed + slack);
    EXPECT_LE(w.norm(), PoseFollower::kMostTurn + slack);
    EXPECT_LE((v - v_before).norm(), PoseFollower::kMostAcceleration * dt + slack);
    EXPECT_LE((w - w_before).norm(), PoseFollower::kMostTurnAcceleration * dt + slack);
    EXPECT_LE((position(pose) - position(before)).norm(), PoseFollower::kMostSpeed * dt + 2e-9);
    EXPECT_LE(orientation(pose).angularDistance(orientation(before)), PoseFollower::kMostTurn * dt + 2e-8);
    EXPECT_NEAR(orientation(pose).norm(), 1, 1e-12);
  }
};

TEST(PoseFollower, KeepsItsBoundsWhateverTheLeaderSays) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> within(-1, 1);
  for (const double rate : {10.0, 500.0, 1000.0, 20000.0}) {
    WatchTarget led;
    for (int i = 0; i < 20000; ++i) {
      hapticd_target target = targetAt(5 * Vector3d(within(random), within(random), within(random)));
      const double twist = std::pow(10, 3 * within(random)) * (i % 7 == 0 ? 1e300 : 1);
      for (int k = 0; k < 3; ++k) target.linear[k] = twist * within(random), target.angular[k] = twist * within(random);
      Eigen::Vector4d q(within(random), within(random), within(random), within(random));
      q.normalize();
      for (int k = 0; k < 4; ++k) target.orientation[k] = q[k];
      if (i % 3 == 0) led.follow.aim(target, led.t + 0.05 * within(random));
      if (i % 1000 == 999) led.follow.release();
      led.step((i % 50 == 0 ? 3 : 1) / rate);  // missed ticks
    }
    EXPECT_LT(position(led.pose).norm(), 20);
  }
}

TEST(PoseFollower, DoesNotLagBehindALeaderOfConstantVelocity) {
  WatchTarget led;
  const Vector3d speed(0.3, -0.2, 0.1);
  for (int i = 0; i < 2000; ++i) {
    if (i % 16 == 0) led.follow.aim(targetAt(led.t * speed, speed), led.t);
    led.step(1e-3);
    if (i > 500) {
      EXPECT_LT((position(led.pose) - led.t * speed).norm(), 1e-6);
    }
  }
}

TEST(PoseFollower, ComesToRestAtATargetAndStays) {
  for (const double dt : {1e-4, 1e-3, 0.1}) {
    WatchTarget led;
    led.follow.aim(targetAt({0.1, 0, 0}), 0);
    for (int i = 0; i < 5 / dt; ++i) led.step(dt);
    EXPECT_EQ(position(led.pose), Vector3d(0.1, 0, 0));
    EXPECT_TRUE(led.follow.rests());
    EXPECT_TRUE(Vector3d(led.pose.linear).isZero(0));
  }
}

TEST(PoseFollower, NeverGoesPastATargetAtRest) {
  WatchTarget led;
  led.follow.aim(targetAt({0.5, 0, 0}), 0);
  for (int i = 0; i < 3000; ++i) {
    led.step(1e-3);
    EXPECT_LE(led.pose.position[0], 0.5 + 1e-9);
  }
}

TEST(PoseFollower, TurnsTheShortWayAndStops) {
  WatchTarget led;
  hapticd_target target = targetAt(Vector3d::Zero());
  const Quaterniond goal(Eigen::AngleAxisd(3.0, Vector3d(1, 2, 3).normalized()));
  target.orientation[0] = -goal.w();  // the other sign of the same turn
  for (int k = 0; k < 3; ++k) target.orientation[k + 1] = -goal.vec()[k];
  led.follow.aim(target, 0);
  double turned = 0;
  for (int i = 0; i < 4000; ++i) {
    const Quaterniond before = orientation(led.pose);
    led.step(1e-3);
    turned += before.angularDistance(orientation(led.pose));
  }
  EXPECT_LT(orientation(led.pose).angularDistance(goal), 1e-7);
  EXPECT_NEAR(turned, 3.0, 1e-3);
  EXPECT_TRUE(led.follow.rests());
}

TEST(PoseFollower, RestsSoonAfterTheLeaderFallsSilent) {
  for (const double speed : {0.1, 0.5, 0.8, 0.9}) {  // at the bound itself the start is never made up for
    WatchTarget led;
    const Vector3d along(speed, 0, 0);
    double silent_at = 0, silent_from = 0;
    for (int i = 0; i < 2000; ++i) {
      if (led.t < 1) {
        led.follow.aim(targetAt(led.t * along, along), led.t);
        silent_at = led.t, silent_from = led.t * speed;
      }
      led.step(1e-3);
      if (led.t > silent_at + 0.2) {
        EXPECT_LT(Vector3d(led.pose.linear).norm(), 1e-3) << speed;
      }
    }
    EXPECT_LE(led.pose.position[0] - silent_from, 0.13 * speed);
    EXPECT_TRUE(led.follow.rests());
  }
}

TEST(PoseFollower, BrakesWithinItsStoppingDistanceWhenTheLeaderGoes) {
  WatchTarget led;
  const Vector3d along(0.8, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    led.follow.aim(targetAt(led.t * along, along), led.t);
    led.step(1e-3);
  }
  const double from = led.pose.position[0];
  led.follow.release();
  for (int i = 0; i < 42; ++i) led.step(1e-3);
  EXPECT_TRUE(led.follow.rests());
  EXPECT_LE(led.pose.position[0] - from, 0.8 * 0.8 / (2 * PoseFollower::kMostAcceleration) + 1e-3);
}

TEST(PoseFollower, IgnoresWhatIsOlderThanWhatItFollows) {
  PoseFollower follow;
  follow.begin(poseAt(Vector3d::Zero()));
  EXPECT_TRUE(follow.aim(targetAt({1, 0, 0}), 0.5));
  EXPECT_FALSE(follow.aim(targetAt({-1, 0, 0}), 0.4));
  EXPECT_TRUE(follow.aim(targetAt({1, 0, 0}), 0.5));
}

TEST(PoseFollower, RefusesWhatIsNoTarget) {
  const hapticd_target good = targetAt({1, 2, 3}, {1, 1, 1}, 100);
  EXPECT_TRUE(PoseFollower::sound(good, 100));
  EXPECT_TRUE(PoseFollower::sound(good, 99.95)) << "written after the deadline of a late tick";
  EXPECT_FALSE(PoseFollower::sound(good, 99.5)) << "ahead";
  auto bad = good;
  bad.position[1] = 11;
  EXPECT_FALSE(PoseFollower::sound(bad, 100));
  bad = good, bad.position[0] = bad.position[1] = bad.position[2] = 9;
  EXPECT_FALSE(PoseFollower::sound(bad, 100));
  bad = good, bad.orientation[0] = 0.9;
  EXPECT_FALSE(PoseFollower::sound(bad, 100));
  bad = good, bad.time = -1;
  EXPECT_FALSE(PoseFollower::sound(bad, 100));
  constexpr double kBad[] = {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL};
  for (size_t field = 0; field < sizeof good / sizeof(double); ++field)
    for (const double value : kBad) {
      bad = good;
      reinterpret_cast<double*>(&bad)[field] = value;
      EXPECT_FALSE(PoseFollower::sound(bad, 100)) << field << " " << value;
    }
  bad = good, bad.orientation[2] = 1e300;
  EXPECT_FALSE(PoseFollower::sound(bad, 100));
}

/// A leader behind a bad network: 60 Hz, a fifth of its records lost, up to 50 ms late.
TEST(PoseFollower, AddsLittleForceToTheTrueMotionBehindABadNetwork) {
  constexpr double kAmplitude = 0.05, kOmega = 2 * M_PI * 0.5, kDt = 1e-3, kStiffness = 800;
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    struct Packet {
      double arrives;
      hapticd_target target;
    };
    std::deque<Packet> network;
    for (int i = 0; i < 60 * 10; ++i) {
      const double t = i / 60.0;
      const Vector3d p(kAmplitude * std::sin(kOmega * t), 0, 0), v(kAmplitude * kOmega * std::cos(kOmega * t), 0, 0);
      if (unit(random) > 0.2) network.push_back({t + 0.05 * unit(random), targetAt(p, v, t)});
    }
    WatchTarget led;
    double worst = 0;
    for (int i = 0; i < 10000; ++i) {
      for (const Packet& packet : network)
        if (packet.arrives > led.t && packet.arrives <= led.t + kDt) led.follow.aim(packet.target, packet.target.time);
      const double before = led.pose.position[0];
      led.step(kDt);
      const double true_step = kAmplitude * (std::sin(kOmega * led.t) - std::sin(kOmega * (led.t - kDt)));
      if (led.t > 1) worst = std::max(worst, kStiffness * std::abs(led.pose.position[0] - before - true_step));
    }
    EXPECT_LE(worst, 0.2) << "seed " << seed;
    RecordProperty("worst_extra_force_step_mN_seed" + std::to_string(seed), static_cast<int>(1e3 * worst));
  }
}

}  // namespace
}  // namespace hapticd::servo
