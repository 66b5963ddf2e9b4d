// SPDX-License-Identifier: MIT
/// What is found on the buses of a machine, by folders that look like /sys and /dev.
#include "diagnostics/machine/device_bus.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <map>

namespace hapticd::diagnostics {
namespace {

class DeviceBus : public ::testing::Test {
 protected:
  DeviceBus() { std::filesystem::remove_all(root_); }
  ~DeviceBus() override { std::filesystem::remove_all(root_); }

  void plug(const std::string& port, const std::map<std::string, std::string>& facts) {
    const std::filesystem::path folder = root_ / "sys/bus/usb/devices" / port;
    std::filesystem::create_directories(folder);
    for (const auto& [name, text] : facts) std::ofstream(folder / name) << text << "\n";
  }
  std::vector<BusDevice> scan(const std::vector<KnownDevice>& own = {}) const {
    return scanBuses(own, root_ / "sys", root_ / "dev");
  }

  std::filesystem::path root_ = testing::TempDir() + "device-bus-" + std::to_string(getpid());
};

TEST_F(DeviceBus, TwoArmsOfOneKindDifferBySerialNumberOrPort) {
  plug("1-1", {{"idVendor", "0403"}, {"idProduct", "cb48"}, {"serial", "FT1"}});
  plug("1-2.3", {{"idVendor", "0403"}, {"idProduct", "cb48"}, {"busnum", "1"}, {"devnum", "17"}});
  plug("1-4", {{"idVendor", "046d"}, {"idProduct", "c52b"}});  // a mouse
  const auto found = scan();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].bus, "usb 1-1");
  EXPECT_EQ(found[0].serial, "FT1");
  EXPECT_EQ(found[1].port, "1-2.3");
  EXPECT_EQ(found[1].serial, "");
  EXPECT_EQ(found[1].node, (root_ / "dev/bus/usb/001/017").string());
  EXPECT_FALSE(found[1].may_open);
}

TEST_F(DeviceBus, AnArmOfOnesOwnIsFoundByTheIdOfItsFile) {
  plug("2-1", {{"idVendor", "12ab"}, {"idProduct", "0001"}, {"product", "My arm"}});
  EXPECT_TRUE(scan().empty());
  const auto found = scan({{"12AB:0001", "mine", "usb_hid"}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].product, "mine \"My arm\"");
  EXPECT_EQ(found[0].module, "usb_hid");
}

TEST_F(DeviceBus, OfSeveralFilesEachArmHasTheNameOfItsOwn) {
  plug("1-1", {{"idVendor", "12ab"}, {"idProduct", "0001"}, {"serial", "A1"}});
  plug("1-2", {{"idVendor", "12ab"}, {"idProduct", "0001"}});
  plug("1-3", {{"idVendor", "12ab"}, {"idProduct", "0001"}});
  const auto found = scan({{"12ab:0001", "left", "usb_hid", "", "1-2"}, {"12ab:0001", "right", "usb_hid", "A1", ""}});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].product, "right");
  EXPECT_EQ(found[1].product, "left");
  EXPECT_EQ(found[2].product, "like left");
}

TEST_F(DeviceBus, EveryProductOfAVendorIsKnownByTheVendorAlone) {
  plug("1-1", {{"idVendor", "2988"}, {"idProduct", "0304"}});
  ASSERT_EQ(scan().size(), 1u);
  EXPECT_EQ(scan()[0].module, "");
}

}  // namespace
}  // namespace hapticd::diagnostics
