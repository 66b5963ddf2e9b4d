// SPDX-License-Identifier: MIT
/// A light plate that turns between fingers that stay where they are: no contact gives it energy.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "kernels/dynamics/rigid_body.hpp"
#include "support/sweep.hpp"

namespace hapticd::dynamics {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kWidth = 0.12, kThickness = 0.012;  // [m] the plate: x from 0 to kWidth, z from -kThickness to 0

/// A finger at rest, and its contact with one side of the plate.
class Finger {
 public:
  Finger(const Vector3d& place, double side, const contact::WallLaw& wall) : side_(side) {
    last_.probe = place;
    last_.law = wall;
  }

  /// Traces the side of the plate. A contact begins where the finger was in front of this side in the last tick.
  void trace(const RigidBody& body) {
    const Quaterniond turn = body.orientation();
    const Vector3d in_plate = turn.conjugate() * (last_.probe - body.position());
    const double surface = side_ > 0 ? 0 : -kThickness, depth = side_ * (surface - in_plate.z());
    const bool beside = in_plate.x() < 0 || in_plate.x() > kWidth;
    traced_ = !beside && (depth <= 0 || traced_ || first_);
    first_ = false;
    last_.depth = traced_ ? depth : -1;
    last_.normal = turn * Vector3d(0, 0, side_);
    last_.point = body.position() + turn * Vector3d(in_plate.x(), in_plate.y(), surface);
  }

  /// @param moves velocity of the finger [m/s]
  void addPress(const RigidBody& body, double dt, std::vector<PredictedContact>& presses,
                const Vector3d& moves = Vector3d::Zero()) const {
    if (!traced_) return;
    const Vector3d velocity = body.velocityAt(last_.point);
    const double closing = last_.normal.dot(velocity - moves);
    const PredictedContact press = predict(last_, last_.probe + dt * moves, closing, velocity, dt);
    if (!press.force.isZero(0)) presses.push_back(press);
  }

  void moveBy(const Vector3d& way) { last_.probe += way; }
  /// Returns the force [N] on the finger that moves at a velocity.
  double force(const RigidBody& body, const Vector3d& velocity) const {
    const double closing = last_.normal.dot(body.velocityAt(last_.point) - velocity);
    return traced_ && last_.depth > 0 ? contact::wallForce(last_.law, last_.depth, closing).force : 0;
  }
  double energy() const { return contact::wallEnergy(last_.law, std::max(0.0, last_.depth)); }

 private:
  double side_;
  bool traced_ = false, first_ = true;
  LastContact last_;
};

/// Random numbers of one case.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double between(double lowest, double highest) {
    return lowest + (highest - lowest) * (engine_() / 4294967295.0);  // the same on every machine
  }
  double magnitude(double lowest, double highest) { return std::pow(10, between(lowest, highest)); }

 private:
  std::mt19937 engine_;
};

RigidBodyLaw plate(Dice& dice, Joint joint) {
  RigidBodyLaw law;
  law.mass = dice.magnitude(-4, 0.5);
  law.center = {kWidth / 2, 0, -kThickness / 2};
  law.inertia = law.mass * Vector3d(2.2e-3, 1.2e-3, 3.3e-3).asDiagonal();
  law.joint = joint;
  if (joint == Joint::kFree) {
    law.tether = dice.magnitude(0, 3);
  } else {
    law.angular_tether = dice.magnitude(-3, 1);
    law.rest = dice.between(-0.5, 0.5);
    law.limits = {-0.6, 0.6};
  }
  return law;
}

/// Returns the largest energy of a plate that strikes the fingers again and again, over all energy at the start.
double gainOf(unsigned seed, Joint joint, double dt) {
  Dice dice(seed);
  RigidBody body(plate(dice, joint), Vector3d::Zero(), Quaterniond::Identity(), Vector3d::Zero());
  body.setVelocity(Vector3d(0, 0, joint == Joint::kFree ? dice.between(-1, 1) : 0),
                   Vector3d(0, dice.between(-30, 30), 0));
  const contact::WallLaw wall{dice.magnitude(2, 3.5), dice.between(0, 5), 1, 1e-3};
  std::vector<Finger> fingers;
  for (const double side : {1.0, -1.0}) {
    const double height = side > 0 ? dice.between(-0.004, 0.03) : -kThickness - dice.between(-0.004, 0.03);
    fingers.emplace_back(Vector3d(dice.between(0.01, kWidth), 0, height), side, wall);
    fingers.back().trace(body);
  }
  const double start = body.energy() + fingers[0].energy() + fingers[1].energy();
  double most = 0;
  std::vector<PredictedContact> presses;
  for (int i = 0; i < 1000; ++i) {
    presses.clear();
    for (const Finger& finger : fingers) finger.addPress(body, dt, presses);
    body.step(presses, dt);
    for (Finger& finger : fingers) finger.trace(body);
    most = std::fmax(most, body.energy());
  }
  return most / start;
}

double worstGain(Joint joint, double dt) {
  const unsigned cases = support::kLong ? 2000 : 250;
  double worst = 0;
  for (unsigned seed = 0; seed < cases; ++seed) worst = std::fmax(worst, gainOf(seed, joint, dt));
  std::printf("%u plates at %g Hz: at most %.6f of the energy at the start\n", cases, 1 / dt, worst);
  return worst;
}

TEST(TurningContact, ALightHingeGainsNoEnergyFromFingersAtRest) {
  for (const double dt : {2e-3, 1e-3, 2.5e-4}) EXPECT_LE(worstGain(Joint::kHinge, dt), 1 + 1e-9);
}

TEST(TurningContact, ALightHingeThatTurnsFarInATickStaysBounded) {
  // it turns by up to a third of a radian in a tick, so the surface is not where it was predicted
  for (const double dt : {1e-2, 5e-3}) EXPECT_LE(worstGain(Joint::kHinge, dt), 1.1);
}

TEST(TurningContact, ALightFreeBodyGainsNoEnergyFromFingersAtRest) {
  for (const double dt : {2e-3, 1e-3, 2.5e-4}) EXPECT_LE(worstGain(Joint::kFree, dt), 1 + 1e-9);
}

constexpr contact::WallLaw kSoftWall{170, 5, 1, 1e-3};

/// Returns the greatest force [N] on a finger that pushes one wing of a light plate, which turns about its middle.
double forceOfAPush(double speed, double dt) {
  RigidBodyLaw law;
  law.mass = 7e-5;
  law.center = {kWidth / 2, 0, -kThickness / 2};
  law.inertia = law.mass * Vector3d(2.2e-3, 1.2e-3, 3.3e-3).asDiagonal();
  law.joint = Joint::kHinge;
  law.pivot = {0.03, 0, -0.009};
  RigidBody body(law, Vector3d::Zero(), Quaterniond::Identity(), Vector3d::Zero());
  Finger finger({0.1, 0, 0.002}, 1, kSoftWall);
  finger.trace(body);
  const Vector3d velocity(0, 0, -speed);
  double most = 0;
  std::vector<PredictedContact> presses;
  for (int i = 0; i * dt * speed < 0.03; ++i) {
    presses.clear();
    finger.addPress(body, dt, presses, velocity);
    finger.moveBy(dt * velocity);
    body.step(presses, dt);
    finger.trace(body);
    most = std::fmax(most, finger.force(body, velocity));
  }
  return most;
}

TEST(TurningContact, ALightHingeYieldsToAFinger) {
  for (const double dt : {2e-3, 1e-3, 2.5e-4})
    for (const double speed : {0.05, 0.3, 1.0}) {
      const double of_one_tick = contact::wallForce(kSoftWall, speed * dt, speed).force;  // if it stood still in a tick
      EXPECT_LT(forceOfAPush(speed, dt), of_one_tick) << dt << " " << speed;
    }
}

}  // namespace
}  // namespace hapticd::dynamics
