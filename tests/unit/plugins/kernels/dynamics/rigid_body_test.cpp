// SPDX-License-Identifier: MIT
#include "kernels/dynamics/rigid_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "support/sweep.hpp"

namespace hapticd::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

const Vector3d kNothing = Vector3d::Zero();

RigidBody bodyOf(const RigidBodyLaw& law, const Vector3d& gravity = kNothing) {
  return RigidBody(law, kNothing, Quaterniond::Identity(), gravity);
}

RigidBodyLaw middleAxisTop() {
  RigidBodyLaw law;
  law.inertia = Vector3d(1, 2, 3).asDiagonal();
  return law;
}

TEST(FreeTop, KeepsEnergyAndMomentumForMillionsOfTicks) {
  RigidBody body = bodyOf(middleAxisTop());
  body.setVelocity(kNothing, {0.13, 1.76, 0.27});  // next to the middle axis: it tumbles
  const double energy = body.energy();
  const Vector3d momentum = body.momentum();
  double worst = 0;
  const int ticks = support::kLong ? 10'000'000 : 1'000'000;
  for (int i = 0; i < ticks; ++i) {
    body.step(kNothing, kNothing, 1e-3);
    if (i % 1000 == 0) worst = std::fmax(worst, std::fabs(body.energy() / energy - 1));
  }
  RecordProperty("worst_energy", std::to_string(worst));
  EXPECT_LT(worst, 1e-9);
  EXPECT_EQ(body.momentum(), momentum);
}

TEST(FreeTop, KeepsItsEnergyAtAnySpeedWhateverItsInertia) {
  for (const Vector3d& moments : {Vector3d(1, 2, 3), Vector3d(1, 1, 1e-3), Vector3d(2, 2.1, 4), Vector3d(1, 1, 1)})
    for (const double rate : {0.01, 10.0, 50.0, 300.0}) {  // 300 rad/s at 1 kHz is 0.3 rad a tick
      RigidBodyLaw law;
      law.inertia = moments.asDiagonal();
      RigidBody body = bodyOf(law);
      body.setVelocity(kNothing, rate * Vector3d(0.13, 1.76, 0.27).normalized());
      const double energy = body.energy();
      double worst = 0;
      for (int i = 0; i < 50'000; ++i) {
        body.step(kNothing, kNothing, 1e-3);
        worst = std::fmax(worst, std::fabs(body.energy() / energy - 1));
      }
      EXPECT_LT(worst, 1e-9) << moments.transpose() << " at " << rate;
    }
}

Vector3d rateAfter(const RigidBodyLaw& law, double time, int steps, const Vector3d& torque) {
  RigidBody body = bodyOf(law);
  body.setVelocity(kNothing, {0.13, 1.76, 0.27});
  for (int i = 0; i < steps; ++i) body.step(kNothing, torque, time / steps);
  return body.bodyRate();
}

double orderOf(const RigidBodyLaw& law, double time, int steps, const Vector3d& torque) {
  const Vector3d truth = rateAfter(law, time, 32 * steps, torque);
  const auto error = [&](int n) { return (rateAfter(law, time, n, torque) - truth).norm(); };
  return std::log2(error(steps) / error(2 * steps));
}

TEST(FreeTop, ConvergesWithFourthOrder) {
  EXPECT_NEAR(orderOf(middleAxisTop(), 20, 1600, kNothing), 4, 0.2);
}

TEST(RigidBody, DampedTopConvergesWithSecondOrder) {
  RigidBodyLaw law = middleAxisTop();
  law.angular_damping = 0.2;
  EXPECT_NEAR(orderOf(law, 5, 400, kNothing), 2, 0.2);
  EXPECT_NEAR(orderOf(middleAxisTop(), 5, 400, {0.1, -0.2, 0.3}), 2, 0.2);
}

TEST(RigidBody, ASymmetricTopIsExactWhateverTheStep) {
  RigidBodyLaw law;
  law.inertia = Vector3d(2, 2, 1).asDiagonal();
  RigidBody coarse = bodyOf(law), fine = bodyOf(law);
  coarse.setVelocity(kNothing, {1, 2, 30});
  fine.setVelocity(kNothing, {1, 2, 30});
  for (int i = 0; i < 100; ++i) coarse.step(kNothing, kNothing, 0.01);
  for (int i = 0; i < 10'000; ++i) fine.step(kNothing, kNothing, 1e-4);
  EXPECT_LT(coarse.orientation().angularDistance(fine.orientation()), 1e-12);
}

TEST(RigidBody, FallsOnAParabolaWhateverTheStep) {
  const Vector3d gravity(0, -9.81, 0);
  for (const int steps : {1, 7, 100}) {
    RigidBody body = bodyOf(RigidBodyLaw{}, gravity);
    body.setVelocity({0.3, 1, 0}, kNothing);
    for (int i = 0; i < steps; ++i) body.step(kNothing, kNothing, 1.0 / steps);
    EXPECT_LT((body.position() - Vector3d(0.3, 1 - 9.81 / 2, 0)).norm(), 1e-12) << steps;
  }
}

TEST(RigidBody, WithDragFallsToItsTerminalSpeedAsTheClosedFormSays) {
  RigidBodyLaw law;
  law.mass = 2;
  law.damping = 5;
  RigidBody body = bodyOf(law, {0, -9.81, 0});
  for (int i = 0; i < 10; ++i) body.step(kNothing, kNothing, 0.05);
  EXPECT_NEAR(body.linear().y(), -2 * 9.81 / 5 * -std::expm1(-5.0 / 2 * 0.5), 1e-12);
}

TEST(RigidBody, OnATetherSwingsExactlyAndReturns) {
  RigidBodyLaw law;
  law.mass = 2;
  law.tether = 50;
  RigidBody body = bodyOf(law);
  body.setVelocity({0, 0, 1}, kNothing);
  for (int i = 0; i < 100; ++i) body.step(kNothing, kNothing, 0.02);
  EXPECT_NEAR(body.position().z(), std::sin(5 * 2.0) / 5, 1e-12);
}

TEST(RigidBody, TurnsAboutItsCentreAndNotItsOrigin) {
  RigidBodyLaw law;
  law.center = {0.1, 0, 0};
  RigidBody body = bodyOf(law);
  body.setVelocity(kNothing, {0, 0, 1});
  for (int i = 0; i < 1000; ++i) body.step(kNothing, kNothing, 1e-3);
  EXPECT_LT((body.position() - Vector3d(0.1 - 0.1 * std::cos(1.0), -0.1 * std::sin(1.0), 0)).norm(), 1e-12);
  EXPECT_LT((body.linear() - Vector3d(0, 0, 1).cross(body.position() - body.center())).norm(), 1e-12);
}

TEST(RigidBody, AHingedBodyIsAPendulum) {
  RigidBodyLaw law;
  law.joint = Joint::kHinge;
  law.mass = 0.5;
  law.pivot = {0, 0.25, 0.3};
  law.axis = {0, 0, 2};
  law.inertia = Vector3d(1e-3, 2e-3, 1.5e-3).asDiagonal();
  RigidBody body = bodyOf(law, {0, -9.81, 0});
  body.setVelocity(kNothing, {5, 5, 3});  // only its part about the axis stays
  const PendulumLaw pendulum{0.5, 1.5e-3 + 0.5 * 0.25 * 0.25, 0.25, 0, 9.81};
  PendulumState state{0, 3};
  for (int i = 0; i < 3000; ++i) {
    body.step(kNothing, kNothing, 1e-3);
    state = advance(pendulum, state, 0, 1e-3);
  }
  EXPECT_NEAR(body.position().x(), 0.25 * std::sin(state.angle), 1e-10);
  EXPECT_NEAR(body.position().y(), 0.25 - 0.25 * std::cos(state.angle), 1e-10);
  EXPECT_NEAR(body.angular().z(), state.rate, 1e-9);
}

TEST(RigidBody, ATetherOnAHingePullsBackToWhereItStarted) {
  RigidBodyLaw law;
  law.joint = Joint::kHinge;
  law.pivot = {-0.2, 0, 0};
  law.axis = {0, 0, 1};
  law.tether = 100;
  law.angular_damping = 0.2;
  RigidBody body = bodyOf(law);
  body.setVelocity(kNothing, {0, 0, 4});
  double farthest = 0;
  for (int i = 0; i < 30'000; ++i) {
    body.step(kNothing, kNothing, 1e-3);
    farthest = std::fmax(farthest, body.position().norm());
    ASSERT_NEAR((body.position() - law.pivot).norm(), 0.2, 1e-14);
  }
  EXPECT_GT(farthest, 0.01);
  EXPECT_LT(body.position().norm(), 1e-9);
}

TEST(RigidBody, ASliderMovesAlongItsAxisAndNeverTurns) {
  RigidBodyLaw law;
  law.joint = Joint::kSlider;
  law.axis = {1, 1, 0};
  RigidBody body = bodyOf(law, {0, -9.81, 0});
  body.setVelocity({1, 0, 5}, {3, 3, 3});
  for (int i = 0; i < 500; ++i) body.step({0, 0, 7}, {1, 1, 1}, 1e-3);
  const double way = 0.5 * std::sqrt(0.5) - 9.81 * std::sqrt(0.5) * 0.125;
  EXPECT_LT((body.position() - way * Vector3d(1, 1, 0).normalized()).norm(), 1e-12);
  EXPECT_EQ(body.orientation().angularDistance(Quaterniond::Identity()), 0);
}

TEST(RigidBody, NotANumberPushesNothing) {
  RigidBody body = bodyOf(RigidBodyLaw{});
  body.step({NAN, 0, 0}, {0, INFINITY, 0}, 1e-3);
  PredictedContact press;
  press.force = {NAN, 0, 0};
  body.step({&press, 1}, 1e-3);
  body.step(kNothing, kNothing, NAN);
  EXPECT_EQ(body.position(), kNothing);
}

TEST(RigidBody, RefusesWhatNoBodyIs) {
  const auto refuses = [](auto change) {
    RigidBodyLaw law;
    change(law);
    EXPECT_THROW(bodyOf(law), std::invalid_argument);
  };
  refuses([](RigidBodyLaw& law) { law.mass = 0; });
  refuses([](RigidBodyLaw& law) { law.mass = NAN; });
  refuses([](RigidBodyLaw& law) { law.inertia(0, 0) = -1; });
  refuses([](RigidBodyLaw& law) { law.inertia(0, 1) = 1e-4; });
  refuses([](RigidBodyLaw& law) { law.damping = -1; });
  refuses([](RigidBodyLaw& law) {
    law.joint = Joint::kHinge;
    law.axis.setZero();
  });
}

}  // namespace
}  // namespace hapticd::dynamics
