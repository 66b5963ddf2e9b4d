// SPDX-License-Identifier: MIT
/// The bulk transport and its I/O thread with the real libusb: open by serial number, push, stall, lose, find again.
#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>

#include "emulators/wire_file.hpp"
#include "played_link_test.hpp"
#include "played_usb.hpp"
#include "usb_bulk/bulk_transport.hpp"
#include "wire_arm/falcon_loader.hpp"

namespace hapticd::wire_arm {
namespace {

using emulator::Fault;
using emulator::PlayedUsb;
using emulator::UsbArm;

constexpr const char* kFile = HAPTICD_SOURCE_DIR "/config/devices/premium15-bulk.yaml";

class BulkTest : public PlayedLinkTest {
 protected:
  std::unique_ptr<Link> make(const std::string& serial = "", const std::string& port = "") {
    LinkSettings s;
    s.address.vendor = 0x1209, s.address.product = 0x0006, s.address.serial = serial, s.address.port = port;
    s.session.calibration = Calibration::kDevice;
    s.session.health.least_rate = 0;  // a busy machine may well be slow
    s.log = [](int, const std::string&) {};
    return std::make_unique<Link>(makeBulkTransport(), wire, std::move(s));
  }

  /// The motors go off, the trouble has this name, and once `repair` was called the arm pushes again.
  void expectTroubleAndRecovery(const std::function<void(PlayedUsb&)>& spoil, Trouble trouble,
                                const std::function<void(PlayedUsb&)>& repair) {
    PlayedUsb device(testbed, 0, left);
    device.plug();
    auto link = make();
    const auto opened = link->open();
    ASSERT_TRUE(opened) << opened.error();
    ASSERT_TRUE(link->start());
    ASSERT_TRUE(pushUntil(*link, [&](const Sample&) { return device.pushed(); }));
    spoil(device);
    EXPECT_TRUE(pushUntil(*link, [&](const Sample& s) { return s.trouble == trouble; })) << describe(trouble);
    EXPECT_TRUE(pushUntil(*link, [&](const Sample&) { return !device.pushed(); })) << "motors stay on";
    repair(device);
    EXPECT_TRUE(pushUntil(*link, [&](const Sample& s) { return s.trouble == Trouble::kNone && device.pushed(); }));
    link->close();
    EXPECT_FALSE(device.pushed()) << "motors are off at the end";
  }

  codec::Wire wire = codec::readWire(emulator::wireOf(kFile), 3);
  UsbArm left{"premium15-bulk", emulator::defaultHand("premium15-bulk"), "A1"};
  UsbArm right{"premium15-bulk", emulator::defaultHand("premium15-bulk"), "B2"};
};

TEST_F(BulkTest, FindsTheArmByItsSerialNumberAmongTwo) {
  PlayedUsb a(testbed, 0, left), b(testbed, 1, right);
  a.plug();
  b.plug();
  auto link = make("B2");
  const auto opened = link->open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_EQ(opened->serial, "B2");
  ASSERT_TRUE(link->start());
  ASSERT_TRUE(pushUntil(*link, [&](const Sample&) { return b.pushed(); }));
  EXPECT_EQ(a.commands(), 0u);
  const auto missing = make("C3")->open();
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().find("serial C3"), std::string::npos) << missing.error();
}

TEST_F(BulkTest, FindsTheArmByItsPortAmongTwo) {
  PlayedUsb a(testbed, 0, left), b(testbed, 1, right);
  a.plug();
  b.plug();
  const auto opened = make("", "1-2")->open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_EQ(opened->serial, "B2");
  const auto missing = make("", "1-4")->open();
  ASSERT_FALSE(missing);
  for (const char* words : {"1209:0006 at port 1-4 not found", "serial A1 at port 1-1", "serial B2 at port 1-2"})
    EXPECT_NE(missing.error().find(words), std::string::npos) << missing.error();
}

/// The user would look for the rights of the arm that is meant, which is not there.
TEST_F(BulkTest, AnotherArmThatCannotBeOpenedIsNotTheOneThatIsMissing) {
  PlayedUsb a(testbed, 0, left), b(testbed, 1, right);
  a.plug();
  b.plug();
  ASSERT_EQ(::unlink((umockdev_testbed_get_root_dir(testbed) + std::string("/dev/bus/usb/001/002")).c_str()), 0);
  const auto missing = make("", "1-4")->open();
  ASSERT_FALSE(missing);
  for (const char* words : {"at port 1-4 not found; devices with this id: ", "one at port 1-1 that cannot be opened: ",
                            "serial B2 at port 1-2", "correct usb.serial, usb.port or usb.interface"})
    EXPECT_NE(missing.error().find(words), std::string::npos) << missing.error();
  const auto meant = make("", "1-1")->open();
  ASSERT_FALSE(meant);
  EXPECT_NE(meant.error().find("at port 1-1 cannot be opened: "), std::string::npos) << meant.error();
  EXPECT_TRUE(make("B2")->open());
}

TEST_F(BulkTest, AnInterfaceThatDoesNotExistIsNotInUse) {
  PlayedUsb a(testbed, 0, left);
  a.plug();
  LinkSettings s;
  s.address.vendor = 0x1209, s.address.product = 0x0006, s.address.interface = 200;
  const auto refused = Link(makeBulkTransport(), wire, std::move(s)).open();
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("does not give its interface 200: "), std::string::npos) << refused.error();
}

TEST_F(BulkTest, UnpluggedIsNamedAndTheArmFoundAgain) {
  expectTroubleAndRecovery([](PlayedUsb& d) { d.unplug(); }, Trouble::kUnplugged, [](PlayedUsb& d) { d.plug(); });
}

TEST_F(BulkTest, AStalledEndpointIsReopenedWhileReportsComeIn) {
  expectTroubleAndRecovery([](PlayedUsb& d) { d.fail(UsbArm::kOut, -EPIPE); }, Trouble::kStalled,
                           [](PlayedUsb& d) { d.fail(0, 0); });
}

TEST_F(BulkTest, AStalledEndpointOfReportsIsReopened) {
  expectTroubleAndRecovery([](PlayedUsb& d) { d.fail(UsbArm::kIn, -EPIPE); }, Trouble::kStalled,
                           [](PlayedUsb& d) { d.fail(0, 0); });
}

TEST_F(BulkTest, FailingTransfersAreABusError) {
  expectTroubleAndRecovery([](PlayedUsb& d) { d.fail(UsbArm::kIn, -EPROTO); }, Trouble::kBusError,
                           [](PlayedUsb& d) { d.fail(0, 0); });
}

TEST_F(BulkTest, ShortCorruptAndMissingReportsAreNamed) {
  const std::pair<Fault, Trouble> cases[] = {{Fault::kShort, Trouble::kShort},
                                             {Fault::kCorrupt, Trouble::kCorrupt},
                                             {Fault::kSilent, Trouble::kStale},
                                             {Fault::kFirmware, Trouble::kFirmware},
                                             {Fault::kHardware, Trouble::kHardware}};
  for (const auto& [fault, trouble] : cases)
    expectTroubleAndRecovery([&](PlayedUsb& d) { d.spoil(fault); }, trouble,
                             [](PlayedUsb& d) { d.spoil(Fault::kNone); });
}

TEST_F(BulkTest, TheLastCommandIsNotCancelledWhileTheDeviceIsBusy) {
  PlayedUsb device(testbed, 0, left);
  device.plug();
  auto link = make();
  ASSERT_TRUE(link->open());
  ASSERT_TRUE(link->start());
  ASSERT_TRUE(pushUntil(*link, [&](const Sample&) { return device.pushed(); }));
  device.takeCommandsAfter(3);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(pushUntil(*link, [](const Sample&) { return true; }));
  link->close();
  EXPECT_FALSE(device.pushed()) << "motors off was in a queue of this process when it closed the device";
}

TEST_F(BulkTest, TheFalconTakesItsFirmwareThroughTheRealLibusb) {
  UsbArm falcon("falcon", emulator::defaultHand("falcon"), "F1");
  falcon.chip().beDifficult(3, 1);
  PlayedUsb device(testbed, 0, falcon);
  device.plug();
  const codec::Wire falcon_wire =
      codec::readWire(emulator::wireOf(HAPTICD_SOURCE_DIR "/config/devices/falcon.yaml"), 3);
  LinkSettings s;
  s.address.vendor = 0x0403, s.address.product = 0xcb48;
  s.session.calibration = Calibration::kDevice;
  s.session.health.least_rate = 0;
  s.log = [](int, const std::string&) {};
  s.prepare = [&](Transport& to) { return loadFalcon(to, falcon_wire, emulator::falconImage()); };
  Link link(makeBulkTransport(), falcon_wire, std::move(s));
  const auto opened = link.open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_GE(falcon.chip().uploads(), 2) << "the first was spoilt on purpose";
  ASSERT_TRUE(link.start());
  EXPECT_TRUE(pushUntil(link, [&](const Sample& sample) { return sample.calibrated && device.pushed(); }));
}

}  // namespace
}  // namespace hapticd::wire_arm
