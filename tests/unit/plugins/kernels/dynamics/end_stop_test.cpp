// SPDX-License-Identifier: MIT
/// Hinges and sliders with end stops and springs: where they rest, and that no stop gives energy to a hand.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "kernels/dynamics/oscillator.hpp"
#include "kernels/dynamics/rigid_body.hpp"

namespace hapticd::dynamics {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const Vector3d kZero = Vector3d::Zero(), kEarth(0, -9.81, 0);
constexpr double kRates[] = {500, 1000, 4000, 10'000};

RigidBodyLaw hinge(double angular_tether, JointLimits limits = {}) {
  RigidBodyLaw law;
  law.joint = Joint::kHinge;
  law.axis = Vector3d::UnitZ();
  law.pivot = {-0.2, 0, 0};
  law.mass = 0.5;
  law.inertia = Vector3d(1e-3, 1e-3, 2e-3).asDiagonal();
  law.angular_tether = angular_tether;
  law.limits = limits;
  return law;
}

RigidBodyLaw slider(double tether, JointLimits limits = {}) {
  RigidBodyLaw law;
  law.joint = Joint::kSlider;
  law.axis = Vector3d::UnitY();
  law.mass = 0.5;
  law.tether = tether;
  law.limits = limits;
  return law;
}

RigidBody jointed(const RigidBodyLaw& law, const Vector3d& gravity = kZero) {
  return RigidBody(law, {0.1, 0.2, 0.3}, Quaterniond(0.8, 0, 0, 0.6), gravity);
}

void push(RigidBody& body, const RigidBodyLaw& law, double effort, double dt) {
  const Vector3d axis = Quaterniond(0.8, 0, 0, 0.6) * law.axis;
  law.joint == Joint::kHinge ? body.step(kZero, effort * axis, dt) : body.step(effort * axis, kZero, dt);
}

TEST(EndStop, AHingeOnASpringSwingsWithTheRootOfStiffnessOverInertia) {
  const double inertia = 2e-3 + 0.5 * 0.04;  // about the pivot
  for (const double rate : kRates) {
    RigidBodyLaw law = hinge(8);
    law.rest = 0.4;
    RigidBody body = jointed(law);
    const double w = std::sqrt(8 / inertia);
    for (int i = 1; i <= 10'000; ++i) {
      body.step(kZero, kZero, 1 / rate);
      ASSERT_NEAR(body.jointPosition(), 0.4 - 0.4 * std::cos(w * i / rate), 1e-9) << rate;
    }
  }
}

TEST(EndStop, ASliderSwingsAboutTheRestOfItsSpring) {
  RigidBodyLaw law = slider(50);
  law.rest = -0.02;
  RigidBody body = jointed(law);
  for (int i = 1; i <= 5000; ++i) {
    body.step(kZero, kZero, 1e-3);
    ASSERT_NEAR(body.jointPosition(), -0.02 + 0.02 * std::cos(10 * i * 1e-3), 1e-12);
  }
}

TEST(EndStop, ASpringThatReachesBeyondTheStopHoldsTheBodyAtIt) {
  for (const double rate : kRates)
    for (RigidBodyLaw law : {hinge(8, {-0.3, 0.5}), slider(60, {-0.3, 0.5})}) {
      law.rest = 2;
      RigidBody body = jointed(law);
      for (int i = 0; i < 4 * rate; ++i) body.step(kZero, kZero, 1 / rate);
      EXPECT_NEAR(body.jointPosition(), 0.5, 1e-15);
      EXPECT_EQ(body.stop(), Stop::kHighest);
      EXPECT_EQ(body.linear(), kZero) << "no tremor: the rate is exactly 0";
      EXPECT_EQ(body.angular(), kZero);
      const Vector3d position = body.position();
      const Quaterniond orientation = body.orientation();
      for (int i = 0; i < 1000; ++i) {
        body.step(kZero, kZero, 1 / rate);
        ASSERT_EQ(body.position(), position) << "the same bits in every tick";
        ASSERT_EQ(body.orientation().coeffs(), orientation.coeffs());
      }
    }
}

TEST(EndStop, ABodyWithWeightRestsOnItsLowerStop) {
  RigidBodyLaw lever = hinge(0, {-0.4, 0.4});
  RigidBody fallen = jointed(lever, kEarth);
  for (int i = 0; i < 3000; ++i) fallen.step(kZero, kZero, 1e-3);
  EXPECT_EQ(fallen.jointPosition(), -0.4);
  EXPECT_EQ(fallen.angular(), kZero);
  RigidBody drawer = jointed(slider(0, {-0.05, 0}), kEarth);
  for (int i = 0; i < 3000; ++i) drawer.step(kZero, kZero, 1e-3);
  EXPECT_NEAR(drawer.jointPosition(), -0.05, 1e-15);
  EXPECT_EQ(drawer.linear(), kZero);
}

TEST(EndStop, CountsWholeTurns) {
  RigidBodyLaw law = hinge(0, {-1, 15});
  RigidBody knob = jointed(law);
  knob.setVelocity(kZero, {0, 0, 5});
  double last = 0;
  for (int i = 0; i < 5000; ++i) {
    knob.step(kZero, kZero, 1e-3);
    ASSERT_LT(std::fabs(knob.jointPosition() - last), 0.01);
    last = knob.jointPosition();
  }
  EXPECT_EQ(last, 15);
}

TEST(EndStop, AStartIntoTheStopHasNoVelocity) {
  for (const RigidBodyLaw& law : {hinge(0, {0, 1}), slider(0, {0, 1})}) {
    RigidBody body = jointed(law);
    body.setVelocity(-3 * (Quaterniond(0.8, 0, 0, 0.6) * Vector3d::UnitY()), {0, 0, -3});
    EXPECT_EQ(body.energy(), 0);
  }
}

/// Ticks of a body under random efforts. @return the largest gain of energy over the work in a tick [J]
double largestGain(const RigidBodyLaw& law, const Vector3d& gravity, double rate, uint32_t seed, int& at_stop) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> effort(-3, 3), share(0, 1);
  RigidBody body = jointed(law, gravity);
  double now = 0, worst = 0;
  for (int i = 0; i < 6000; ++i) {
    if (share(random) < 0.02) now = share(random) < 0.3 ? 0 : effort(random);  // also lets go
    const double before = body.energy(), from = body.jointPosition();
    push(body, law, now, 1 / rate);
    const double way = body.jointPosition() - from;
    EXPECT_GE(body.jointPosition(), law.limits.lowest - 1e-15);
    EXPECT_LE(body.jointPosition(), law.limits.highest + 1e-15);
    worst = std::fmax(worst, body.energy() - before - now * way);
    at_stop += body.stop() != Stop::kNone ? 1 : 0;
  }
  return worst;
}

TEST(EndStop, NeverGivesMoreEnergyThanTheHandPutIn) {
  int at_stop = 0, ticks = 0;
  double worst = 0, worst_weight = 0;
  for (const double rate : kRates)
    for (uint32_t seed = 1; seed <= 10; ++seed)
      for (RigidBodyLaw law : {hinge(0, {-0.2, 0.3}), hinge(5, {-0.2, 0.3}), hinge(2000, {-0.001, 0.001}),
                               slider(0, {-0.02, 0.03}), slider(300, {-0.02, 0.03})}) {
        law.damping = seed % 3 == 0 ? 1 : 0;
        law.rest = seed % 2 == 0 ? 0.1 : 0;
        worst = std::fmax(worst, largestGain(law, kZero, rate, seed, at_stop));
        const bool exact = law.joint == Joint::kSlider;  // also with weight
        double& of_weight = exact ? worst : worst_weight;
        of_weight = std::fmax(of_weight, largestGain(law, kEarth, rate, seed, at_stop));
        ticks += 2 * 6000;
      }
  std::printf(
      "%d ticks, %d of them at a stop: at most %.2g J more than the work in a tick, a hinge with weight %.2g J\n",
      ticks, at_stop, worst, worst_weight);
  EXPECT_GT(at_stop, ticks / 10);
  EXPECT_LT(at_stop, ticks * 9 / 10);
  EXPECT_LT(worst, 1e-12);
  EXPECT_LT(worst_weight, 1e-5) << "its weight is integrated to second order";
}

/// A hand of 0.2 kg on a spring to its target, in front of a body that it touches along x.
class PressingHand {
 public:
  explicit PressingHand(double dt) : dt_(dt), step_(oscillatorStep(0.2, 5, kSpring, dt)) {}
  double force() const { return force_; }
  double depth() const { return last_.depth; }
  double speed() const { return std::fabs(v_); }

  /// Makes a tick of the servo: moves the body under the last contact, presses on it, and moves the hand.
  void tick(RigidBody& body, const contact::WallLaw& wall, double target) {
    const PredictedContact press = predict(last_, {x_, 0, 0}, v_ - body.linear().x(), body.linear(), dt_);
    body.step({&press, press.force.isZero(0) || !touched_ ? size_t{0} : size_t{1}}, dt_);
    touched_ = true;
    last_.probe = {x_, 0, 0};
    last_.point = body.position();
    last_.normal = -Vector3d::UnitX();
    last_.depth = x_ - body.position().x();
    last_.law = wall;
    force_ = contact::wallForce(wall, last_.depth, v_ - body.linear().x()).force;
    double from_rest = x_ - (target - force_ / kSpring);
    const double rest = target - force_ / kSpring;
    advance(step_, from_rest, v_);
    x_ = rest + from_rest;
  }

 private:
  static constexpr double kSpring = 500;
  double dt_;
  OscillatorStep step_;
  LastContact last_;
  bool touched_ = false;
  double x_ = -0.005, v_ = 0, force_ = 0;
};

RigidBody drawer(double mass, double tether, const JointLimits& limits) {
  RigidBodyLaw law = slider(tether, limits);
  law.axis = Vector3d::UnitX();
  law.mass = mass;
  return RigidBody(law, kZero, Quaterniond::Identity(), kZero);
}

TEST(EndStop, AHandThatPressesABodyAgainstItFeelsTheWholeWallAndNoTremor) {
  const contact::WallLaw wall{800, 2, 1, 1e-3};
  for (const double rate : kRates)
    for (const double mass : {1e-4, 0.1, 5.0})
      for (const double tether : {0.0, 40.0}) {
        RigidBody body = drawer(mass, tether, {0, 0.02});
        PressingHand hand(1 / rate);
        const auto ticks = static_cast<int>(6 * rate);
        for (int i = 0; i < ticks; ++i) hand.tick(body, wall, 0.05);
        const double depth = (0.05 - 0.02) * 500 / (500 + 800);  // two springs in series: hand and wall
        EXPECT_NEAR(hand.depth(), depth, 1e-6) << rate << ' ' << mass;
        EXPECT_NEAR(hand.force(), 800 * depth, 1e-3) << "no part of it moves the body";
        EXPECT_LT(hand.speed(), 1e-6);
        EXPECT_EQ(body.linear(), kZero);
        double greatest = hand.force();
        for (int i = 0; i < ticks; ++i) {  // draws back: the force only falls, but a spring may bring the body after it
          hand.tick(body, wall, -0.05);
          ASSERT_LE(hand.force(), greatest + 1e-9) << rate << ' ' << mass << ' ' << i;
          if (tether == 0) greatest = std::fmin(greatest, hand.force());
          ASSERT_GE(body.position().x(), 0) << "its other stop holds it";
        }
        EXPECT_EQ(body.position().x(), tether > 0 ? 0 : 0.02) << "the spring brings it back; without one it stays";
        EXPECT_EQ(body.linear(), kZero);
      }
}

TEST(EndStop, RefusesLimitsThatHoldNothing) {
  const auto complaint = [](const RigidBodyLaw& law) -> std::string {
    try {
      jointed(law);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(complaint(hinge(0, {1.2, -0.3})).find("expected [lowest, highest]: [-0.3, 1.2]"), std::string::npos);
  EXPECT_NE(complaint(hinge(0, {0, 0})).find("no room to move"), std::string::npos);
  EXPECT_NE(complaint(hinge(0, {0.2, 1})).find("does not contain 0"), std::string::npos);
  EXPECT_NE(complaint(slider(0, {-1, -0.2})).find("does not contain 0"), std::string::npos);
  EXPECT_NE(complaint(slider(0, {NAN, 1})).find("not a number"), std::string::npos);
  EXPECT_NE(complaint(slider(0, {-1, NAN})).find("not a number"), std::string::npos);
  RigidBodyLaw free;
  free.limits = {-1, 1};
  EXPECT_NE(complaint(free).find("free body"), std::string::npos);
  RigidBodyLaw soft = hinge(-1);
  EXPECT_NE(complaint(soft).find("angular_tether"), std::string::npos);
  soft = hinge(1);
  soft.rest = NAN;
  EXPECT_NE(complaint(soft).find("rest"), std::string::npos);
  EXPECT_EQ(complaint(hinge(1, {0, 1})), "");
}

}  // namespace
}  // namespace hapticd::dynamics
