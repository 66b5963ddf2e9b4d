#include <gtest/gtest.h>

#include <cmath>

#include "kernels/contact/friction.hpp"
#include "kernels/dynamics/button.hpp"
#include "kernels/dynamics/oscillator.hpp"
#include "kernels/dynamics/pendulum.hpp"
#include "kernels/dynamics/rigid_body.hpp"

namespace hapticd::dynamics {
namespace {

using Eigen::Vector3d;

TEST(Rotation, AMillionTicksOfConstantRotationDriftByRoundingOnly) {
  const Vector3d turn(1e-3, -2e-3, 2e-3);  // 3e-3 rad a tick
  Rotation rotation;
  for (int i = 0; i < 1'000'000; ++i) rotation.turnWorld(turn);
  const double angle = std::remainder(static_cast<double>(1'000'000.0L * 3e-3L), 2 * M_PI);
  const Eigen::Quaterniond truth(Eigen::AngleAxisd(angle, turn.normalized()));
  EXPECT_LT(rotation.quaternion().angularDistance(truth), 1e-12);
  EXPECT_LT((rotation.matrix().transpose() * rotation.matrix() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST(RigidBody, AFreeTopKeepsEnergyAndMomentum) {
  RigidBodyLaw law;
  law.inertia = Vector3d(1, 2, 3).asDiagonal();
  RigidBody body(law, Vector3d::Zero(), Eigen::Quaterniond::Identity(), Vector3d::Zero());
  body.setVelocity(Vector3d::Zero(), {0.13, 1.76, 0.27});
  const double energy = body.energy();
  const Vector3d momentum = body.momentum();
  for (int i = 0; i < 100'000; ++i) body.step(Vector3d::Zero(), Vector3d::Zero(), 1e-3);
  EXPECT_LT(std::fabs(body.energy() / energy - 1), 1e-11);
  EXPECT_EQ(body.momentum(), momentum);
}

TEST(RigidBody, FallsOnAParabolaWhateverTheStep) {
  const Vector3d gravity(0, -9.81, 0);
  RigidBody body(RigidBodyLaw{}, Vector3d::Zero(), Eigen::Quaterniond::Identity(), gravity);
  for (int i = 0; i < 100; ++i) body.step(Vector3d::Zero(), Vector3d::Zero(), 0.01);
  EXPECT_NEAR(body.position().y(), -9.81 / 2, 1e-12);
}

TEST(Integrators, StayBoundedOverTheWholeGridOfStiffnessMassAndStep) {
  for (double k = 1; k < 2e6; k *= 10)
    for (double m = 1e-6; m < 2e6; m *= 10)
      for (double dt : {1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2})
        for (double zeta : {0.0, 0.3, 1.0, 10.0}) {
          const auto step = oscillatorStep(m, 2 * zeta * std::sqrt(k * m), k, dt);
          double x = 1e-3, v = 0;
          const double energy = k * x * x;
          for (int i = 0; i < 1000; ++i) advance(step, x, v);
          ASSERT_LE(k * x * x + m * v * v, energy * (1 + 1e-9)) << k << ' ' << m << ' ' << dt << ' ' << zeta;
        }
}

TEST(Pendulum, KeepsItsEnergy) {
  PendulumState state{2, 0};
  const double before = energy(PendulumLaw{}, state);
  for (int i = 0; i < 100'000; ++i) state = advance(PendulumLaw{}, state, 0, 1.0 / 1500);
  EXPECT_LT(std::fabs(energy(PendulumLaw{}, state) / before - 1), 1e-11);
}

TEST(Button, SnapsWithHysteresisAndReportsEachClickOnce) {
  const DetentCurve::Knot knots[] = {{0, 0}, {0.003, 6}, {0.004, 2}};
  const DetentCurve detent(knots, 8000);
  ButtonState button;
  int clicks = 0;
  double in = 0, out = 0;
  const auto at = [](int i) { return 8e-3 * i / 8000; };
  for (int i = 0; i <= 8000; ++i)
    if (button.step(2000, detent, at(i)).clicked) ++clicks, in = at(i);
  for (int i = 8000; i >= 0; --i)
    if (button.step(2000, detent, at(i)).clicked) ++clicks, out = at(i);
  EXPECT_EQ(clicks, 2);
  EXPECT_NEAR(in, 0.003 + 6.0 / 2000, 2e-6);
  EXPECT_NEAR(out, 0.004 + 2.0 / 2000, 2e-6);
}

TEST(Friction, IsBoundedAndGivesBackNoMoreThanWasPutIn) {
  contact::Friction friction;
  const contact::FrictionLaw law{0.6, 0.3, 1000, 0};
  const Vector3d normal = Vector3d::UnitY();
  Vector3d last = Vector3d::Zero(), force = Vector3d::Zero();
  double work = 0;  // done by the hand
  for (int i = 0; i <= 200'000; ++i) {
    const double t = 1e-4 * i;
    const Vector3d foot(4e-3 * std::sin(t), 0, 3e-3 * std::sin(1.7 * t));
    const Vector3d next = friction.step(law, foot, normal, 2, Vector3d::Zero());
    work -= (force + next).dot(foot - last) / 2;
    force = next;
    last = foot;
    ASSERT_LE(force.norm(), 0.6 * 2 * (1 + 1e-12));
    ASSERT_GE(work, friction.energy(law) - 1e-6);
  }
  EXPECT_GT(work, 0.01);
}

}  // namespace
}  // namespace hapticd::dynamics
