// SPDX-License-Identifier: MIT
/// When the thread that calls a vendor's library may pass a force on: only a fresh one, of an arm that is well.
#include "vendor_arm/exchange.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

namespace hapticd::vendor_arm {
namespace {

/// An exchange of an arm of 3 N, whose library has given a position.
struct Exchanged {
  Exchanged() {
    exchange.reset(3);
    show();
  }
  void show(bool lost = false, bool fault = false) {
    ArmReading seen;
    seen.sequence = ++shown;
    seen.lost = lost, seen.fault = fault;
    exchange.show(seen);
  }
  void write(uint32_t mode, double x, double y) {
    hdv_command command{sizeof(hdv_command), mode, {x, y}, {}};
    EXPECT_EQ(exchange.write(command), HSP_OK);
  }
  /// The size of the force that the library gets now [N].
  double size() {
    exchange.force(force);
    return std::hypot(force[0], force[1], force[2]);
  }
  /// The size of the force that a command gives. A busy machine may make a command old, so it is repeated.
  double given(double x, double y) {
    double given = 0;
    for (int i = 0; i < 100 && given == 0; ++i) write(HDV_TORQUE, x, y), given = size();
    return given;
  }
  Exchange exchange;
  double force[3] = {};
  uint64_t shown = 0;
};

TEST(Exchange, PassesTheForceOnWithinTheLargestOfTheArm) {
  Exchanged arm;
  EXPECT_EQ(arm.size(), 0) << "nobody has asked for one";
  EXPECT_NEAR(arm.given(0.6, -0.8), 1, 1e-15);
  EXPECT_EQ(arm.force[1], -0.8);
  EXPECT_NEAR(arm.given(6, -8), 3, 1e-15);
  EXPECT_NEAR(arm.force[1], -2.4, 1e-15) << "in its direction";
  EXPECT_EQ(arm.given(std::nan(""), 1), 1) << "a number that is not finite counts as 0";
  arm.write(HDV_OFF, 0.6, -0.8);
  EXPECT_EQ(arm.size(), 0);
}

TEST(Exchange, GivesNoForceAfterACutUntilTheMotorsWereOff) {
  Exchanged arm;
  ASSERT_EQ(arm.given(1, 0), 1);
  arm.exchange.cut();
  EXPECT_EQ(arm.size(), 0);
  EXPECT_EQ(arm.given(1, 0), 0) << "a servo that was stuck goes on";
  arm.write(HDV_OFF, 0, 0);
  EXPECT_EQ(arm.given(1, 0), 1);
}

TEST(Exchange, GivesNoForceOfAServoThatIsSilent) {
  Exchanged arm;
  arm.write(HDV_TORQUE, 1, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(25));
  EXPECT_EQ(arm.size(), 0);
  EXPECT_EQ(arm.given(1, 0), 1);
}

TEST(Exchange, GivesNoForceToAnArmThatIsLostOrAtFault) {
  for (const bool lost : {true, false}) {
    Exchanged arm;
    arm.show(lost, !lost);
    EXPECT_EQ(arm.given(1, 0), 0);
    arm.show();
    EXPECT_EQ(arm.given(1, 0), 1) << "well again";
  }
}

}  // namespace
}  // namespace hapticd::vendor_arm
