// SPDX-License-Identifier: MIT
/// A body between contacts: what a held force would do to it, and that ours does not.
#include <gtest/gtest.h>

#include <cmath>

#include "kernels/dynamics/oscillator.hpp"
#include "kernels/dynamics/rigid_body.hpp"
#include "support/sweep.hpp"

namespace hapticd::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

RigidBody slab(double mass, double drag = 0, double tether = 0) {
  RigidBodyLaw law;
  law.mass = mass;
  law.inertia = mass * Matrix3d::Identity();
  law.joint = Joint::kSlider;
  law.axis = Vector3d::UnitX();
  law.damping = drag;
  law.tether = tether;
  return RigidBody(law, Vector3d::Zero(), Quaterniond::Identity(), Vector3d::Zero());
}

/// What a probe does with the slab's wall, which looks along -x.
LastContact contactAt(const Vector3d& probe, const RigidBody& body, const contact::WallLaw& wall) {
  LastContact last;
  last.probe = probe;
  last.point = body.position();
  last.normal = -Vector3d::UnitX();
  last.depth = probe.x() - body.position().x();
  last.law = wall;
  return last;
}

/// Growth of a body's amplitude over many steps between contacts of stiffness k and damping B, their force held.
double growthWhenHeld(double mass, double k, double damping, double dt) {
  RigidBody body = slab(mass);
  body.setVelocity(Vector3d::UnitX() * 1e-3, Vector3d::Zero());
  const auto size = [&] { return std::hypot(body.position().x() * std::sqrt(k / mass), body.linear().x()); };
  double first = 0;
  for (int i = 0; i < 4000; ++i) {
    const double force = -k * body.position().x() - damping * body.linear().x();
    body.step({force, 0, 0}, Vector3d::Zero(), dt);
    if (i < 400) first = std::fmax(first, size());
    if (size() > 1e3) return 1e9;
  }
  double last = 0;
  for (int i = 0; i < 400; ++i) {
    const double force = -k * body.position().x() - damping * body.linear().x();
    body.step({force, 0, 0}, Vector3d::Zero(), dt);
    last = std::fmax(last, size());
  }
  return last / first;
}

TEST(Coupling, HeldForcesAreStableOnlyAboveTheirBounds) {
  constexpr double kStiffness = 1000, kStep = 1e-3;
  // damping below k dt / 2 gains at every mass
  for (const double mass : {0.01, 0.1, 1.0}) {
    EXPECT_GT(growthWhenHeld(mass, kStiffness, 0.95 * kStiffness * kStep / 2, kStep), 1) << mass;
    EXPECT_LT(growthWhenHeld(mass, kStiffness, 1.05 * kStiffness * kStep / 2, kStep), 1) << mass;
  }
  // and a mass below B dt / 2 whatever the stiffness
  for (const double damping : {1.0, 10.0, 100.0}) {
    EXPECT_GT(growthWhenHeld(0.95 * damping * kStep / 2, 100, damping, kStep), 1) << damping;
    EXPECT_LT(growthWhenHeld(1.05 * damping * kStep / 2, 100, damping, kStep), 1) << damping;
  }
}

/// A body that two probes at rest squeeze from both sides, and what is stored in it and in the two walls.
class Squeezed {
 public:
  Squeezed(double mass, const contact::WallLaw& wall) : body_(slab(mass)), wall_(wall), mass_(mass) {}
  void push(double speed) { body_.setVelocity(Vector3d::UnitX() * speed, Vector3d::Zero()); }
  void step(double dt) {
    std::array<PredictedContact, 2> presses;
    size_t count = 0;
    for (const double side : {-1.0, 1.0}) {
      LastContact last;
      last.normal = side * Vector3d::UnitX();
      last.point = Vector3d::UnitX() * (body_.position().x() + side * kHalf);
      last.probe = side * (kHalf - kDepth) * Vector3d::UnitX();
      last.depth = depth(side);
      last.law = wall_;
      const Vector3d velocity = body_.velocityAt(last.point);
      presses[count] = predict(last, last.probe, last.normal.dot(velocity), velocity, dt);
      if (!presses[count].force.isZero(0)) ++count;
    }
    body_.step({presses.data(), count}, dt);
  }
  double energy() const {
    return mass_ / 2 * body_.linear().squaredNorm() + contact::wallEnergy(wall_, depth(-1)) +
           contact::wallEnergy(wall_, depth(1));
  }

 private:
  static constexpr double kHalf = 0.05, kDepth = 1e-3;
  double depth(double side) const { return kDepth + side * body_.position().x(); }
  RigidBody body_;
  contact::WallLaw wall_;
  double mass_;
};

TEST(Coupling, ASqueezedBodyStaysBoundedOverTheWholeGrid) {
  // pushed by up to half its depth in a tick; energy over that of the start
  int cases = 0;
  constexpr double kOneStep = 1.05;  // one that the linearisation misjudges
  const std::vector<double> ticks =
      support::kLong ? std::vector{1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2} : std::vector{1e-4, 1e-3, 1e-2};
  for (const double exponent : {0.5, 1.0, 1.5}) {
    double worst = 0, worst_end = 0;
    for (double k = 1; k < 2e6; k *= 10)
      for (double m = 1e-6; m < 2e6; m *= 10)
        for (const double dt : ticks)
          for (const double zeta : {0.0, 0.3, 1.0, 10.0}) {
            Squeezed squeezed(m, {k, 2 * zeta * std::sqrt(k * m), exponent, 1e-3});
            squeezed.push(0.5e-3 * std::fmin(std::sqrt(k / m), 1 / dt));
            const double start = squeezed.energy();
            double gain = 0;
            for (int i = 0; i < 300; ++i) {
              squeezed.step(dt);
              gain = squeezed.energy() / start;
              worst = std::fmax(worst, gain);
            }
            worst_end = std::fmax(worst_end, gain);
            EXPECT_LE(worst, kOneStep) << "k " << k << " m " << m << " dt " << dt << " zeta " << zeta << " n "
                                       << exponent;
            EXPECT_LE(gain, 1 + 1e-9) << "k " << k << " m " << m << " dt " << dt << " zeta " << zeta << " n "
                                      << exponent;
            ++cases;
          }
    std::printf("squeezed, n = %.1f: at most %.6f, in the end %.6f of the start's energy\n", exponent, worst,
                worst_end);
  }
  EXPECT_GE(cases, 2500);
  std::printf("%d cases of a squeezed body\n", cases);
}

/// A hand (mass, damping and spring to a target inside the body) pushes a body on a tether: a sampled wall of both.
double tremorOfHand(double body_mass, const contact::WallLaw& wall, int window, double dt, int delay) {
  constexpr double kHandMass = 0.575, kHandDamping = 6.5, kHandSpring = 135, kTarget = 0.02;
  const OscillatorStep hand = oscillatorStep(kHandMass, kHandDamping, kHandSpring, dt);
  RigidBody body = slab(body_mass, 0.5, 20);
  double x = -1e-3, v = 0.1, late = 0;
  std::vector<double> positions(static_cast<size_t>(window) + 1, x), forces(static_cast<size_t>(delay) + 1, 0.0);
  LastContact last;
  const int ticks = static_cast<int>(8 / dt);
  for (int i = 0; i < ticks; ++i) {
    positions.insert(positions.begin(), x);
    positions.pop_back();
    const double estimate = (positions.front() - positions.back()) / (window * dt);
    const Vector3d probe = x * Vector3d::UnitX();
    if (i > 0) {
      const PredictedContact press = predict(last, probe, estimate - body.linear().x(), body.linear(), dt);
      body.step({&press, press.force.isZero(0) ? size_t{0} : size_t{1}}, dt);
    }
    last = contactAt(probe, body, wall);
    forces.insert(forces.begin(), contact::wallForce(wall, last.depth, estimate - body.linear().x()).force);
    forces.pop_back();
    const double rest = kTarget - forces.back() / kHandSpring;
    double from_rest = x - rest;
    advance(hand, from_rest, v);
    x = rest + from_rest;
    if (i > ticks * 3 / 4) late = std::fmax(late, std::fabs(v));
  }
  return late;
}

TEST(Coupling, AHandHoldsABodyOfAnyMassQuietlyWithinTheDelaysOfAServo) {
  for (const double exponent : {0.5, 1.0})
    for (const int delay : {0, 1})
      for (double mass = 1e-6; mass < 2; mass *= std::sqrt(10.0)) {
        const double tremor = tremorOfHand(mass, {1000, 2, exponent, 1e-3}, 3, 1e-3, delay);
        EXPECT_LT(tremor, 5e-3) << "mass " << mass << ", n " << exponent << ", delay " << delay;
      }
}

TEST(Coupling, AWeightlessBodyIsNoDragOnTheHand) {
  // pushed at a constant speed: no force but the mass times its acceleration, which is none
  RigidBody body = slab(1e-6);
  const contact::WallLaw wall{1000, 0, 1, 1e-3};
  LastContact last;
  double force = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d probe = (-1e-4 + 1e-4 * i) * Vector3d::UnitX();  // 0.1 m/s
    if (i > 0) {
      const PredictedContact press = predict(last, probe, 0, body.linear(), 1e-3);
      body.step({&press, press.force.isZero(0) ? size_t{0} : size_t{1}}, 1e-3);
    }
    last = {};
    last.probe = probe;
    last.point = body.position();
    last.normal = -Vector3d::UnitX();
    last.depth = probe.x() - body.position().x();
    last.law = wall;
    force = contact::wallForce(wall, last.depth, 0).force;
  }
  EXPECT_NEAR(body.linear().x(), 0.1, 2e-4);
  EXPECT_LT(force, 1e-6);
}

/// Forces on a hand that presses a body against its tether, and then draws back at once by 0.1 m.
struct LetGo {
  double held = 0, largest_after = 0;
};
LetGo letGo(double mass, double tether, double rate) {
  const double dt = 1 / rate;
  const OscillatorStep hand = oscillatorStep(0.2, 5, 500, dt);
  const contact::WallLaw wall{800, 2, 1, 1e-3};
  RigidBody body = slab(mass, 0.5 * std::sqrt(mass * tether), tether);
  LetGo forces;
  LastContact last;
  double x = -5e-3, v = 0;
  const auto ticks = static_cast<int>(8 * rate);
  for (int i = 0; i < ticks; ++i) {
    const Vector3d probe = x * Vector3d::UnitX();
    if (i > 0) {
      const PredictedContact press = predict(last, probe, v - body.linear().x(), body.linear(), dt);
      body.step({&press, press.force.isZero(0) ? size_t{0} : size_t{1}}, dt);
    }
    last = contactAt(probe, body, wall);
    const double force = contact::wallForce(wall, last.depth, v - body.linear().x()).force;
    (i < ticks / 2 ? forces.held : forces.largest_after) =
        i < ticks / 2 ? force : std::fmax(forces.largest_after, force);
    const double rest = (i < ticks / 2 ? 0.05 : -0.05) - force / 500;
    double from_rest = x - rest;
    advance(hand, from_rest, v);
    x = rest + from_rest;
  }
  return forces;
}

TEST(Coupling, ALightBodyIsNoBlowToTheHandThatLetsItGo) {
  for (const double rate : {500.0, 1000.0, 4000.0, 10'000.0})
    for (const double mass : {1e-4, 1e-3, 5e-3, 0.02, 0.5})
      for (const double tether : {40.0, 400.0}) {
        const LetGo forces = letGo(mass, tether, rate);
        EXPECT_GT(forces.held, 1);
        EXPECT_LT(forces.largest_after, 1.1 * forces.held) << rate << " Hz, " << mass << " kg, " << tether << " N/m";
      }
}

TEST(Coupling, WhatTheProbeLosesTheBodyGains) {
  // a probe of mass 1 kg strikes a free body of 2 kg; the force each feels is that of the same tick
  RigidBody body = slab(2);
  const contact::WallLaw wall{5000, 0, 1, 1e-3};
  double x = -1e-3, v = 0.3;
  LastContact last;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d probe = x * Vector3d::UnitX();
    if (i > 0) {
      const PredictedContact press = predict(last, probe, 0, body.linear(), 2.5e-4);
      body.step({&press, press.force.isZero(0) ? size_t{0} : size_t{1}}, 2.5e-4);
    }
    last = contactAt(probe, body, wall);
    const double force = contact::wallForce(wall, last.depth, 0).force;
    v -= 2.5e-4 * force;
    x += 2.5e-4 * v;
  }
  EXPECT_LT(v, 0) << "the lighter one bounces";
  EXPECT_NEAR(v + 2 * body.linear().x(), 0.3, 0.3 * 1e-3);
}

}  // namespace
}  // namespace hapticd::dynamics
