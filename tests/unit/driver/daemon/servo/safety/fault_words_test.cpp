// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "servo/safety/fault.hpp"

namespace hapticd::servo {
namespace {

TEST(FaultWords, AreOfEveryFaultItsOwn) {
  std::set<std::string> seen;
  for (int i = 0; i < kFaultCount; ++i) EXPECT_TRUE(seen.insert(describe(static_cast<Fault>(i))).second) << i;
  EXPECT_EQ(seen.count("unknown fault"), 0u);
  EXPECT_STREQ(describe(static_cast<Fault>(kFaultCount)), "unknown fault") << "the last of them is counted";
}

TEST(FaultWords, NameTheStateInItsUnit) {
  const auto says = [](Fault fault, const char* text) {
    return faultMessage("arm", fault, 12.5).find(text) != std::string::npos;
  };
  for (const Fault fault : {Fault::kTooFast, Fault::kJumped}) EXPECT_TRUE(says(fault, " (measured: 12.5 m/s);"));
  for (const Fault fault : {Fault::kStale, Fault::kLate, Fault::kStuck})
    EXPECT_TRUE(says(fault, " (measured: 12.5 s);"));
  EXPECT_TRUE(says(Fault::kOverheated, " (measured: 12.5 degC);"));
  for (const Fault fault : {Fault::kNotFinite, Fault::kDeviceLost, Fault::kStopped, Fault::kNotCalibrated})
    EXPECT_FALSE(says(fault, "measured"));
}

TEST(FaultWords, HaveTheConsequenceAndTheCure) {
  EXPECT_EQ(faultMessage("arm", Fault::kTooFast, 7),
            "device arm: the tip moved faster than limits.velocity (measured: 7 m/s); its forces ended and stay off "
            "until the fault is cleared; hold the arm still, then: hapticd ctl clear");
  EXPECT_EQ(faultMessage("arm", Fault::kStale, 0.06, "no report came; look at the cable"),
            "device arm: no report came (measured: 0.06 s); its forces ended and come back in a ramp once the device "
            "works again; "
            "look at the cable");
  EXPECT_EQ(faultMessage("arm", Fault::kNotCalibrated, 0, nullptr, "my-arm.yaml"),
            "device arm: the device is not calibrated; its forces ended and come back in a ramp once the device works "
            "again; run: hapticd device calibrate my-arm.yaml");
  EXPECT_EQ(faultMessage("arm", Fault::kStopped, 0),
            "device arm: stopped by the user; its forces ended and stay off until the fault is cleared");
}

TEST(FaultWords, NameACommandThatHelps) {
  for (int i = 0; i < kFaultCount; ++i) {
    const auto fault = static_cast<Fault>(i);
    const bool helps = std::string(describe(fault)).find("hapticd ") != std::string::npos;
    EXPECT_EQ(helps, fault != Fault::kNone && fault != Fault::kStopped) << describe(fault);
  }
  EXPECT_EQ(faultMessage("arm", Fault::kNotFinite, 0, nullptr, "my-arm.yaml"),
            "device arm: a force or position was not a number; its forces ended and stay off until the fault is "
            "cleared; check its module: hapticd device check my-arm.yaml, then: hapticd ctl clear");
}

TEST(FaultWords, SayWhichEndByThemselves) {
  const std::set<Fault> ends{Fault::kDeviceLost, Fault::kDeviceFault, Fault::kStale, Fault::kNotCalibrated};
  for (int i = 0; i < kFaultCount; ++i)
    EXPECT_EQ(endsByItself(static_cast<Fault>(i)), ends.count(static_cast<Fault>(i)) == 1) << i;
}

TEST(FaultWords, ALatchedFaultIsCopied) {
  LatchedFault one;
  EXPECT_EQ(one.get(), Fault::kNone);
  one.set(Fault::kLate);
  LatchedFault two(one), three;
  three = one;
  one.set(Fault::kNone);
  EXPECT_EQ(two.get(), Fault::kLate);
  EXPECT_EQ(three.get(), Fault::kLate);
}

}  // namespace
}  // namespace hapticd::servo
