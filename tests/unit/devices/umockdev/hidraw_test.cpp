// SPDX-License-Identifier: MIT
/// The HID transport and its I/O thread with the real hidapi: open by serial number, push, lose, find again.
#include <gtest/gtest.h>

#include <functional>

#include "emulators/wire_file.hpp"
#include "played_hidraw.hpp"
#include "played_link_test.hpp"
#include "usb_hid/hid_transport.hpp"

namespace hapticd::wire_arm {
namespace {

class HidrawTest : public PlayedLinkTest {
 protected:
  std::unique_ptr<Link> make(const std::string& serial, const std::string& port = "") {
    LinkSettings s;
    s.address.vendor = 0x1234, s.address.product = 0x0006, s.address.serial = serial, s.address.port = port;
    s.session.calibration = Calibration::kNone;
    s.session.health.least_rate = 0;  // a busy machine may well be slow
    s.log = [](int, const std::string&) {};
    return std::make_unique<Link>(makeHidTransport(), wire, std::move(s));
  }

  codec::Wire wire = codec::readWire(emulator::wireOf(HAPTICD_SOURCE_DIR "/config/devices/woodenhaptics.yaml"), 3);
  emulator::EmulatedArm left{"woodenhaptics", emulator::defaultHand("woodenhaptics")};
  emulator::EmulatedArm right{"woodenhaptics", emulator::defaultHand("woodenhaptics")};
};

TEST_F(HidrawTest, FindsTheArmByItsSerialNumberAmongTwo) {
  emulator::PlayedHidraw a(testbed, 0, left, "A1"), b(testbed, 1, right, "B2");
  a.plug();
  b.plug();
  auto link = make("B2");
  const auto opened = link->open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_EQ(opened->serial, "B2");
  const auto started = link->start();
  ASSERT_TRUE(started) << started.error();
  ASSERT_TRUE(pushUntil(*link, [&](const Sample&) { return b.pushed.load(); }));
  EXPECT_FALSE(a.pushed);
  auto other = make("A1");
  EXPECT_TRUE(other->open()) << "the other arm is free";
  auto third = make("C3");
  const auto missing = third->open();
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().find("A1"), std::string::npos) << missing.error();
}

TEST_F(HidrawTest, FindsTheArmByItsPortIfItHasNoSerialNumber) {
  emulator::PlayedHidraw a(testbed, 0, left, ""), b(testbed, 1, right, "");
  a.plug();
  b.plug();
  auto link = make("", "2-2");
  const auto opened = link->open();
  ASSERT_TRUE(opened) << opened.error();
  ASSERT_TRUE(link->start());
  ASSERT_TRUE(pushUntil(*link, [&](const Sample&) { return b.pushed.load(); }));
  EXPECT_FALSE(a.pushed);
  const auto missing = make("", "2-4")->open();
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().find("at port 2-4 not found; devices with this id: no serial number at port 2-1, no serial "
                                 "number at port 2-2"),
            std::string::npos)
      << missing.error();
}

TEST_F(HidrawTest, AnInterfaceThatDoesNotExistIsNamed) {
  emulator::PlayedHidraw a(testbed, 0, left, "A1");
  a.plug();
  LinkSettings s;
  s.address.vendor = 0x1234, s.address.product = 0x0006, s.address.interface = 200;
  const auto missing = Link(makeHidTransport(), wire, std::move(s)).open();
  ASSERT_FALSE(missing);
  for (const char* words : {"1234:0006 interface 200 not found; devices with this id: serial A1", "usb.interface"})
    EXPECT_NE(missing.error().find(words), std::string::npos) << missing.error();
}

TEST_F(HidrawTest, AnArmInUseIsNotTakenTwice) {
  emulator::PlayedHidraw a(testbed, 0, left, "A1");
  a.plug();
  auto first = make(""), second = make("");
  ASSERT_TRUE(first->open());
  const auto refused = second->open();
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("in use"), std::string::npos) << refused.error();
}

TEST_F(HidrawTest, PushesLosesFindsAndPushesAgain) {
  emulator::PlayedHidraw a(testbed, 0, left, "A1");
  a.plug();
  auto link = make("A1");
  ASSERT_TRUE(link->open());
  ASSERT_TRUE(link->start());
  ASSERT_TRUE(pushUntil(*link, [&](const Sample&) { return a.pushed.load(); }));
  a.unplug();
  ASSERT_TRUE(pushUntil(*link, [](const Sample& s) { return s.trouble == Trouble::kUnplugged; }));
  a.pushed = false;
  a.plug();
  ASSERT_TRUE(pushUntil(*link, [&](const Sample& s) { return s.trouble == Trouble::kNone && a.pushed; }));
  link->close();
  EXPECT_FALSE(a.pushed) << "motors are off at the end";
}

}  // namespace
}  // namespace hapticd::wire_arm
