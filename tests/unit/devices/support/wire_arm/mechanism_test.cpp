// SPDX-License-Identifier: MIT
/// Mechanisms from device files: stops that a file gives are those that the kinematics keep.
#include "wire_arm/mechanism.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <string>

namespace hapticd::wire_arm {
namespace {

using kinematics::JointVector;

MechanismParameters woodenHaptics() {
  MechanismParameters p;
  p.kind = static_cast<int>(Kind::kPhantom);
  p.lengths = {0.205, 0.245, 0, 0, 0};
  p.limits = {-1.0, 1.0, 0.2, 1.8, 0.5, 2.5};
  return p;
}

TEST(Mechanism, JointLimitsOfTheFileBoundTheInverse) {
  const auto arm = makeMechanism(woodenHaptics());
  EXPECT_EQ(arm->limits().max[1], 1.8);
  JointVector q(3), free(3);
  q << 0.2, 1.9, 1.95;  // the PHANToM could, this arm cannot
  EXPECT_FALSE(arm->allowed(q));
  kinematics::Pose tip;
  ASSERT_TRUE(arm->forward(q, tip));
  free << 0, 1, 1.5;
  EXPECT_FALSE(arm->inverse(tip.position, free));
  MechanismParameters wide = woodenHaptics();
  wide.limits.clear();
  EXPECT_TRUE(makeMechanism(wide)->inverse(tip.position, free));
}

TEST(Mechanism, ThereAndBackIsTheSameWithinAPicometre) {
  MechanismParameters delta;
  delta.kind = static_cast<int>(Kind::kDelta);
  std::mt19937_64 random(3);
  for (const MechanismParameters& p : {MechanismParameters{}, woodenHaptics(), delta}) {
    const auto arm = makeMechanism(p);
    int tried = 0;
    for (int i = 0; i < 2000; ++i) {
      JointVector q(3);
      for (int j = 0; j < 3; ++j)
        q[j] = std::uniform_real_distribution<double>(arm->limits().min[j], arm->limits().max[j])(random);
      kinematics::Pose there, back;
      if (!arm->allowed(q) || !arm->forward(q, there)) continue;
      JointVector found = q;
      if (!arm->inverse(there.position, found)) continue;  // the other assembly of a delta
      ++tried;
      ASSERT_TRUE(arm->forward(found, back));
      EXPECT_LE((back.position - there.position).norm(), 1e-12) << p.kind << ": " << q.transpose();
    }
    EXPECT_GT(tried, 400) << p.kind;
  }
}

/// Returns what makeMechanism() refuses.
std::string refusalOf(const MechanismParameters& p) {
  try {
    makeMechanism(p);
    return "";
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

TEST(Mechanism, AllThatIsWrongIsToldAtOnce) {
  MechanismParameters chain;
  chain.kind = static_cast<int>(Kind::kChain);
  chain.dh = {0, 1.57, 0.1, 0, 0.2, 0, 0, 0, 0.2, 0, 0, 0};
  EXPECT_EQ(refusalOf(chain), "");
  EXPECT_EQ(jointsOf(chain), 3u);
  chain.limits = {-1, 1, 1, -1};
  chain.masses = {1};
  chain.base_orientation = {0.7, 0.7, 0.7, 0};
  const std::string said = refusalOf(chain);
  for (const char* expected :
       {"arm.base_orientation: the quaternion has length 1.2124", "arm.limits: 2 rows, expected 3",
        "arm.limits[1]: [1, -1], expected the smaller number first", "arm.masses: 1 number, expected 3"})
    EXPECT_NE(said.find(expected), std::string::npos) << expected << " in " << said;
  EXPECT_EQ(jointsOf(chain), 3u);
  MechanismParameters phantom = woodenHaptics();
  phantom.masses = {1};
  phantom.limits = {1, -1};
  EXPECT_NE(refusalOf(phantom).find("arm.masses: 1 number, expected 4"), std::string::npos) << refusalOf(phantom);
  EXPECT_NE(refusalOf(phantom).find("arm.limits: 1 row, expected 3"), std::string::npos) << refusalOf(phantom);
}

TEST(Mechanism, WrongLimitsAreNamed) {
  MechanismParameters p = woodenHaptics();
  p.limits = {-1, 1, 0, 1};
  EXPECT_THROW(makeMechanism(p), std::invalid_argument);
  p.limits = {-1, 1, 2, 1, 0, 1};
  EXPECT_THROW(makeMechanism(p), std::invalid_argument);
}

}  // namespace
}  // namespace hapticd::wire_arm
