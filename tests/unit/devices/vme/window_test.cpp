// SPDX-License-Identifier: MIT
/// The window's ioctls, answered by a kernel that umockdev plays: what is asked for, and every refusal in words.
#include "vme/window.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <umockdev.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "vme/vme_user.hpp"

namespace hapticd::vme {
namespace {

/// /dev/bus/vme/m0 as a plain file whose bytes are the bus; the master's ioctls go to a handler.
class VmeWindowTest : public ::testing::Test {
 protected:
  VmeWindowTest() : testbed_(umockdev_testbed_new()) {}
  ~VmeWindowTest() override { g_object_unref(testbed_); }
  void SetUp() override {
    if (umockdev_in_mock_environment() == FALSE) GTEST_SKIP() << "umockdev's preload library is not in this process";
    handler_ = umockdev_ioctl_base_new();
    g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(onIoctl), this);
    umockdev_testbed_attach_ioctl(testbed_, "/dev/bus/vme/m0", handler_, nullptr);
    const std::string device =
        "P: /devices/virtual/vme_user/bus!vme!m0\nN: bus/vme/m0=" + std::string(2 * 0x10000, '0') +
        "\nE: SUBSYSTEM=vme_user\nE: DEVNAME=/dev/bus/vme/m0\nE: MAJOR=221\nE: MINOR=0\nA: dev=221:0\\n\n\n";
    ASSERT_TRUE(umockdev_testbed_add_from_string(testbed_, device.c_str(), nullptr));
    place_.node = "/dev/bus/vme/m0";
    place_.address = 0x100000;
  }
  void TearDown() override {
    if (handler_ == nullptr) return;
    umockdev_testbed_detach_ioctl(testbed_, "/dev/bus/vme/m0", nullptr);
    g_object_unref(handler_);
  }

  std::string refused() {
    Window window;
    auto opened = window.open(place_);
    return opened ? "" : opened.error();
  }

  static gboolean onIoctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    return static_cast<VmeWindowTest*>(self)->answer(client);
  }
  gboolean answer(UMockdevIoctlClient* client) {
    const auto request = static_cast<unsigned long>(umockdev_ioctl_client_get_request(client));
    const bool set = request == (old_kernel_ ? kSetOldMaster : kSetMaster);
    const bool get = request == (old_kernel_ ? kGetOldMaster : kGetMaster);
    if (!set && !get) return umockdev_ioctl_client_complete(client, -1, ENOTTY), TRUE;
    UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
    UMockdevIoctlData* data = umockdev_ioctl_data_resolve(arg, 0, _IOC_SIZE(request), nullptr);
    if (set) std::memcpy(master_.data(), data->data, _IOC_SIZE(request));
    if (get) std::memcpy(data->data, master_.data(), _IOC_SIZE(request));
    g_object_unref(data);
    const int error = set ? error_ : 0;
    umockdev_ioctl_client_complete(client, error != 0 ? -1 : 0, error);
    return TRUE;
  }

  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_ = nullptr;
  Place place_;
  std::array<uint8_t, sizeof(OldMaster)> master_{};
  int error_ = 0;
  bool old_kernel_ = false;
};

TEST_F(VmeWindowTest, AsksForTheWindowAndReadsAndWritesInIt) {
  Window window;
  auto opened = window.open(place_);
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_FALSE(window.isFile());
  PackedMaster asked{};
  std::memcpy(&asked, master_.data(), sizeof asked);
  // The records are packed, so a reference to a field may be misaligned: + makes a copy.
  EXPECT_EQ(+asked.enable, 1u);
  EXPECT_EQ(+asked.address, 0x100000u);
  EXPECT_EQ(+asked.size, 0x10000u);
  EXPECT_EQ(+asked.space, kA24);
  EXPECT_EQ(+asked.width, kD16);
  EXPECT_EQ(+asked.cycle, kSingle | kUser | kData);
  const std::array<uint8_t, 4> sent{1, 2, 3, 4};
  std::array<uint8_t, 4> got{};
  EXPECT_EQ(window.write(0x40, sent), 4);
  EXPECT_EQ(window.read(0x40, got), 4);
  EXPECT_EQ(got, sent);
  EXPECT_EQ(window.read(0x10000, got), 0) << "past the window";
  EXPECT_EQ(window.read(0x10000 - 2, got), 2) << "across its end";
}

TEST_F(VmeWindowTest, SpeaksToOldKernelsToo) {
  old_kernel_ = true;
  Window window;
  auto opened = window.open(place_);
  ASSERT_TRUE(opened) << opened.error();
  OldMaster asked{};
  std::memcpy(&asked, master_.data(), sizeof asked);
  EXPECT_EQ(+asked.address, 0x100000u);
  EXPECT_FALSE(window.isFile());
}

TEST_F(VmeWindowTest, EveryRefusalIsInWords) {
  const struct {
    int error;
    const char* words;
  } kCases[] = {{EINVAL, "multiple of 64 KiB"}, {EFAULT, "beyond the address space"}, {ENOMEM, "no room"}};
  for (const auto& c : kCases) {
    error_ = c.error;
    const std::string text = refused();
    EXPECT_NE(text.find(c.words), std::string::npos) << text;
    EXPECT_NE(text.find("A24 0x100000 (64 KiB, D16)"), std::string::npos) << text;
    EXPECT_NE(text.find("fix: "), std::string::npos) << text;
  }
  place_.node = "/dev/bus/vme/m3";
  EXPECT_NE(refused().find("modprobe vme_user"), std::string::npos) << refused();
}

}  // namespace
}  // namespace hapticd::vme
