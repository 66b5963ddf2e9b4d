// SPDX-License-Identifier: MIT
/// The law of a claim, written without a thought for its cost, beside the one that the servo runs: both must let the
/// same bits through, or recordings would not replay.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "servo/safety/claim.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

class Reference {
 public:
  Vector3d check(const ClaimStep& step, const ClaimBounds& bounds, double dt, bool& held) {
    const double asked = step.force.norm();
    const bool beyond = step.max_force > 0 && asked > step.max_force;
    Vector3d let = beyond ? Vector3d(step.force * (step.max_force / asked)) : step.force;
    passes_ = std::min(Claim::kPasses, passes_ + Claim::kPassesPerSecond * dt);
    turns_ = std::min(Claim::kTurns, turns_ + Claim::kTurnsPerSecond * dt);
    finds_anew_ -= dt;
    held = false;
    Vector3d from = let;
    double follows = 1;
    if (known_ && (step.in & (HSP_IN_JUMP | HSP_IN_INVALID)) == 0) {
      const double moved = explained(step, bounds, dt), most = moved + std::max(Claim::kStep, bounds.jump);
      const double square = explained_.squaredNorm();
      from.setZero();
      if (square > 0) from = std::clamp(let.dot(explained_) / square, 0.0, 1.0) * explained_;
      const Vector3d change = let - from;
      const double size = change.norm(), drifted = moved + Claim::kDrift * dt;
      held = size > most && !takePass(step);
      if (held) let = from + change * (most / size);
      if (held || (size <= most && size > drifted)) follows = drifted / std::min(size, most);
    }
    explained_ = from + std::min(1.0, follows) * (let - from);
    last_ = step;
    known_ = (step.in & HSP_IN_INVALID) == 0;
    if ((step.in & (HSP_IN_JUMP | HSP_IN_INVALID)) != 0) finds_anew_ = Claim::kFindsAnew;
    return held ? let : step.force;
  }

 private:
  double explained(const ClaimStep& step, const ClaimBounds& bounds, double dt) {
    double moved = (step.p_model - last_.p_model).norm();
    double speed = std::max(step.velocity.norm(), last_.velocity.norm());
    double change = (step.velocity - last_.velocity).norm(), turned = 0;
    if (step.turn != nullptr) {
      const Vector3d carried = *step.turn * explained_;
      turned = (carried - explained_).norm();
      if (!bounds.moves_itself) explained_ = carried;
    }
    if (bounds.moves_itself) {
      const double own = (step.p_world - last_.p_world).norm();
      moved = std::min(moved, own + ownMotion(step, dt));
      if (dt > 0) speed = std::min(speed, own / dt + Claim::kOwnSpeed);
      change = std::min(change, speed);
      turned = std::min(turned, Claim::kOwnTurn * dt * explained_.norm());
    }
    if (dt > 0) speed = std::max(speed, moved / dt);
    const double stiffness = bounds.stiffness > 0 ? bounds.stiffness : Claim::kUnclaimed;
    return Claim::kMargin * stiffness * moved +
           std::max(Claim::kDamping * change, Claim::kMargin * bounds.damping * speed) +
           (bounds.moves_itself ? turned : 0);
  }
  double ownMotion(const ClaimStep& step, double dt) const {
    const double along = std::min((step.origin - last_.origin).norm(), Claim::kOwnSpeed * dt);
    if (step.turn == nullptr) return along;
    const Vector3d arm = step.p_world - step.origin;
    return along + std::min((*step.turn * arm - arm).norm(), Claim::kOwnTurn * dt * arm.norm());
  }
  bool takePass(const ClaimStep& step) {
    const bool traced = (step.out & HSP_OUT_TRACED) != 0, was = (last_.out & HSP_OUT_TRACED) != 0;
    if (!traced || passes_ < 1) return false;
    if (was && finds_anew_ <= 0 && step.normal.dot(last_.normal) > std::cos(Claim::kEdge)) return false;
    const double turn = step.force.dot(passed_) < 0 ? 1 : 0;
    if (turn > turns_) return false;
    turns_ -= turn;
    passes_ -= 1;
    passed_ = step.force;
    return true;
  }

  bool known_ = false;
  double passes_ = Claim::kPasses, turns_ = Claim::kTurns, finds_anew_ = 0;
  Vector3d explained_ = Vector3d::Zero(), passed_ = Vector3d::Zero();
  ClaimStep last_;
};

/// A probe that wanders, and a shape that answers as a law would, as a click does, or as nothing would.
class Wanderer {
 public:
  explicit Wanderer(unsigned seed) : random_(seed) {
    const double steep[] = {0, 50, 1000, 30000};
    bounds.stiffness = steep[random_() % 4];
    bounds.damping = random_() % 3 == 0 ? 5 : 0;
    bounds.jump = random_() % 3 == 0 ? 4 : 0;
    bounds.moves_itself = random_() % 4 == 0;
    turns_ = bounds.moves_itself || random_() % 3 == 0;
    if (random_() % 2 == 0) step_.max_force = 8.5;
    stiffness_ = std::max(100.0, bounds.stiffness);
  }
  const ClaimStep& next() {
    const double moved = std::pow(10, -7 + 4 * share());
    step_.p_world += moved * any();
    step_.in = chance(200) ? HSP_IN_INVALID : chance(200) ? HSP_IN_JUMP : 0;
    step_.out = chance(20) ? 0 : HSP_OUT_TRACED;
    step_.velocity = moved * 1e3 * any();
    if (chance(30)) normal_ = any().normalized();
    step_.normal = normal_;
    if (turns_) {
      turn_ = Eigen::AngleAxisd((chance(50) ? 1.0 : 1e-3) * share(), any().normalized()).toRotationMatrix();
      step_.turn = &turn_;
      step_.origin += 1e-4 * any();
    }
    step_.p_model = step_.p_world - step_.origin;
    answer();
    return step_;
  }
  double dt() { return chance(100) ? 0 : chance(100) ? 0.05 : 1e-3; }
  ClaimBounds bounds;

 private:
  double share() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  bool chance(unsigned one_in) { return random_() % one_in == 0; }
  Vector3d any() { return {2 * share() - 1, 2 * share() - 1, 2 * share() - 1}; }
  void answer() {
    const double depth = step_.p_model.dot(normal_);
    Vector3d force = std::max(0.0, depth) * stiffness_ * normal_;
    if (chance(10)) force += 5 * any();
    if (chance(50)) force = -force;
    if (chance(50)) force *= 1e3;
    if (chance(20)) force.setZero();
    step_.force = force;
  }
  std::mt19937 random_;
  ClaimStep step_;
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
  Vector3d normal_ = Vector3d::UnitY();
  bool turns_ = false;
  double stiffness_ = 0;
};

bool sameBits(const Vector3d& a, const Vector3d& b) {
  return std::memcmp(a.data(), b.data(), 3 * sizeof(double)) == 0;
}

TEST(Claim, LetsTheSameBitsThroughAsTheLawWithoutShortcuts) {
  int held_back = 0, steps = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    Wanderer hand(seed);
    Claim claim;
    Reference reference;
    for (int i = 0; i < 500; ++i, ++steps) {
      const ClaimStep& step = hand.next();
      const double dt = hand.dt();
      bool held = false, expected_held = false;
      const Vector3d let = claim.check(step, hand.bounds, dt, held);
      const Vector3d expected = reference.check(step, hand.bounds, dt, expected_held);
      ASSERT_EQ(held, expected_held) << "seed " << seed << ", step " << i;
      ASSERT_TRUE(sameBits(let, expected)) << "seed " << seed << ", step " << i;
      held_back += held ? 1 : 0;
    }
  }
  EXPECT_GT(held_back, steps / 50) << "both answers occur";
  EXPECT_LT(held_back, steps / 2);
}

/// A change of the force between what surely is explained and what is not: it is followed by the drift alone.
TEST(Claim, TakesASecondLookAtWhatIsLittleMoreThanTheStiffnessExplains) {
  for (const double part : {0.98, 1.02, 1.4}) {
    ClaimBounds bounds;
    bounds.stiffness = 1000;
    Claim claim;
    bool held = false;
    ClaimStep step;
    claim.check(step, bounds, 0, held);
    step.p_world = step.p_model = {0, 1e-4, 0};
    step.force = {0, part * Claim::kMargin * 1000 * 1e-4, 0};
    claim.check(step, bounds, 1e-6, held);
    ASSERT_FALSE(held);
    step.force = {0, 100, 0};  // without a motion: what was followed, and a click
    const double followed = claim.check(step, bounds, 1e-6, held).y() - Claim::kStep;
    EXPECT_NEAR(followed, std::min(part, 1.0), 3e-4) << part;
  }
}

}  // namespace
}  // namespace hapticd::servo
