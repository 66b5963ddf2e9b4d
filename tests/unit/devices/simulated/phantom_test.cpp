// SPDX-License-Identifier: MIT
/// A PHANToM of any lengths and masses.
#include "module.hpp"
#include "stroke.hpp"

namespace hapticd::simulated {
namespace {

using Eigen::Vector3d;

/// The Premium 1.5 said in the words of a twin: every published number given in the file.
void describePremiumAsPhantom(Module& arm) {
  const std::vector<double> gear = {13.3, 11.2, 11.2};
  arm.set("arm.kind", 2);
  arm.set("arm.lengths", std::vector<double>{0.215, 0.170, 0.0325, -0.0368, 0.0527});
  arm.set("arm.masses", std::vector<double>{0.0202, 0.0249, 0.2359, 0.1906});
  arm.set("arm.inertias", std::vector<double>{0.4864e-4, 0.001843e-4, 0.4864e-4,  // a
                                              0.959e-4, 0.959e-4, 0.0051e-4,      // c
                                              11.09e-4, 10.06e-4, 0.591e-4,       // be
                                              7.11e-4, 0.629e-4, 6.246e-4,        // df
                                              0, 11.87e-4, 0});                   // base
  arm.set("arm.max_torque", std::vector<double>{0.129 * 13.3, 0.129 * 11.2, 0.129 * 11.2});
  arm.set("joint.gear", gear);
  arm.set("joint.counts", std::vector<double>{4096});
  arm.set("joint.rotor", std::vector<double>{1.08e-6});
  arm.set("joint.damping", std::vector<double>{0.0005});
  arm.set("joint.friction", std::vector<double>{0.01});
}

TEST(SimulatedPhantom, APhantomWithThePremiumsNumbersIsThePremium) {
  Module premium, twin;
  describePremiumAsPhantom(twin);
  EXPECT_EQ(strokeOf(premium, 400), strokeOf(twin, 400));
}

// WoodenHaptics, whose calibration pose has the upper body upright, the forearm level and the tip at (0, 0.45, 0.04).
TEST(SimulatedPhantom, APhantomHasTheReachOfItsOwnLengths) {
  Module arm;
  arm.set("arm.kind", 2);
  arm.set("arm.lengths", std::vector<double>{0.205, 0.245, 0, 0, 0});
  arm.set("arm.masses", std::vector<double>{0, 0, 0, 0});
  arm.set("arm.limits", std::vector<double>{-1.5, 1.5, -0.2, 2.2, 0.3, 2.8});
  arm.set("hand.script", kHold);
  arm.set("hand.center", std::vector<double>{0, 0.45, 0.04});
  arm.set("hand.radius", 0.0), arm.set("hand.approach", 0.0);
  ASSERT_EQ(arm.start(), HSP_OK) << arm.said;
  arm.read(kMillisecond);
  EXPECT_LT((arm.joints() - Vector3d(0, M_PI / 2, M_PI / 2)).norm(), 1e-9);
  EXPECT_LT((arm.tip() - Vector3d(0, 0.45, 0.04)).norm(), 1e-9);
  EXPECT_EQ(arm.info.position_max[2], 2.8);
}

TEST(SimulatedPhantom, APhantomWithoutAHandBeginsWithinItsStops) {
  Module arm;
  arm.set("arm.kind", 2);
  arm.set("arm.limits", std::vector<double>{-1.5, 1.5, 0.1, 2.2, 0.3, 2.8});
  arm.set("hand.script", kNone);
  ASSERT_EQ(arm.start(), HSP_OK) << arm.said;
  arm.read(0);
  EXPECT_EQ(arm.joints(), Vector3d(0, 0.1, 0.3));
}

TEST(SimulatedPhantom, SaysWhichListOfAPhantomHasTheWrongLength) {
  const auto said = [](const char* id, size_t numbers) {
    Module arm;
    arm.set("arm.kind", 2);
    arm.set(id, std::vector<double>(numbers, 0.1));
    EXPECT_LT(arm.start(), 0) << id;
    return arm.said;
  };
  EXPECT_NE(said("arm.lengths", 2).find("arm.lengths: 2 numbers, expected 5"), std::string::npos);
  EXPECT_NE(said("arm.masses", 3).find("arm.masses: 3 numbers, expected 4"), std::string::npos);
  EXPECT_NE(said("arm.limits", 4).find("arm.limits: 2 rows, expected 3"), std::string::npos);
  EXPECT_NE(said("arm.max_torque", 2).find("arm.max_torque: 2 numbers, expected 1 or 3"), std::string::npos);
  Module premium;
  premium.set("arm.lengths", std::vector<double>(5, 0.1));
  EXPECT_LT(premium.start(), 0);
  EXPECT_NE(premium.said.find("expected arm.kind phantom"), std::string::npos) << premium.said;
  for (const char* idle : {"arm.masses", "arm.limits", "arm.inertias"}) {
    Module ignoring;
    ignoring.set(idle, std::vector<double>(6, 0.1));
    EXPECT_LT(ignoring.start(), 0) << idle;
    EXPECT_NE(ignoring.said.find(std::string(idle) + ": a premium15 has fixed"), std::string::npos) << ignoring.said;
  }
  Module both;
  both.set("arm.kind", 2);
  both.set("arm.max_torque", std::vector<double>{1}), both.set("joint.max_torque", std::vector<double>{1});
  EXPECT_LT(both.start(), 0);
  EXPECT_NE(both.said.find("remove one of the two"), std::string::npos) << both.said;
}

}  // namespace
}  // namespace hapticd::simulated
