// SPDX-License-Identifier: MIT
#include "simulated/hand.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace hapticd::simulated {
namespace {

using Eigen::Vector3d;

TEST(Hand, WantsTheVelocityOfItsPosition) {
  for (const Script script : {Script::kHold, Script::kStroke, Script::kPress, Script::kTap, Script::kCircle}) {
    HandSettings settings;
    settings.script = script;
    settings.normal = Vector3d(1, 2, 3);
    settings.axis = Vector3d(0, 1, 1);
    const Hand hand(settings, {});
    for (double t = 0.011; t < 4; t += 0.0371) {
      const Vector3d slope = (hand.at(t + 1e-6).position - hand.at(t - 1e-6).position) / 2e-6;
      EXPECT_LT((hand.at(t).velocity - slope).norm(), 1e-7) << "script " << static_cast<int>(script) << " at " << t;
    }
  }
}

TEST(Hand, StartsOutsideAndComesIn) {
  HandSettings settings;
  const Hand hand(settings, {});
  EXPECT_NEAR(hand.at(0).position.norm(), settings.radius + settings.approach, 1e-12);
  for (double t = settings.lead_in; t < 3; t += 0.1) {
    const Vector3d p = hand.at(t).position;
    EXPECT_NEAR(std::hypot(p.x(), p.z()), settings.radius, 1e-12);
    EXPECT_LE(std::abs(p.y()), settings.rise);
  }
}

TEST(Hand, TremblesWithTheStrengthAsked) {
  const BandNoise tremor(0.3, 8, 12, 5);
  Vector3d square = Vector3d::Zero();
  constexpr int kSamples = 200000;
  for (int i = 0; i < kSamples; ++i) square += tremor.at(i * 1e-3).cwiseAbs2() / kSamples;
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::sqrt(square[axis]), 0.3, 0.01);
  EXPECT_NE(BandNoise(0.3, 8, 12, 6).at(1), tremor.at(1));
}

TEST(Hand, RefusesAnAxisAlongItsNormal) {
  HandSettings settings;
  settings.axis = settings.normal;
  for (const Script moves : {Script::kStroke, Script::kCircle}) {
    settings.script = moves;
    EXPECT_THROW(Hand(settings, {}), std::invalid_argument);
  }
  settings.script = Script::kPress;  // moves along the normal alone
  EXPECT_NO_THROW(Hand(settings, {}));
  settings.axis.setZero();
  EXPECT_THROW(Hand(settings, {}), std::invalid_argument);
  settings = {};
  settings.script = Script::kPath;
  EXPECT_THROW(Hand(settings, {}), std::invalid_argument);
}

TEST(HandPath, GoesStraightFromRowToRowAndRestsAtItsEnds) {
  const HandPath path = HandPath::parse("t,x,y,z\n1,0,0,0\n# a comment\n2,2,0,-4\r\n", "p.csv");
  Vector3d p, v;
  path.at(1.25, p, v);
  EXPECT_LT((p - Vector3d(0.5, 0, -1)).norm() + (v - Vector3d(2, 0, -4)).norm(), 1e-15);
  path.at(-3, p, v);
  EXPECT_EQ(p.norm() + v.norm(), 0);
  path.at(9, p, v);
  EXPECT_EQ(p, Vector3d(2, 0, -4));
  EXPECT_EQ(v.norm(), 0);
}

TEST(HandPath, NamesTheLineThatIsWrong) {
  const char* wrong[] = {"t,x,y,z\n0,0,0,0\n1,2,3\n", "t,x,y,z\n0,0,0,0\n1,nan,0,0\n", "t,x,y,z\n0,0,0,0\n0,1,1,1\n",
                         "t,x,y,z\n0,0,0,0\n1,a,0,0\n"};
  for (const char* text : wrong) {
    try {
      HandPath::parse(text, "p.csv");
      ADD_FAILURE() << "accepted: " << text;
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(std::string(e.what()).rfind("p.csv:3:", 0), 0u) << e.what();
    }
  }
  EXPECT_THROW(HandPath::parse("", "p.csv"), std::runtime_error);
  EXPECT_THROW(HandPath::read("/no/such/file.csv"), std::runtime_error);
}

}  // namespace
}  // namespace hapticd::simulated
