// SPDX-License-Identifier: MIT
/// The firmware upload against a Falcon that follows the published protocol, and one that garbles it.
#include "wire_arm/falcon_loader.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "emulators/wire_file.hpp"

namespace hapticd::wire_arm {
namespace {

/// Answers as the boot loader and, once it has the whole firmware, as the firmware.
class FakeFalcon final : public Transport {
 public:
  explicit FakeFalcon(size_t firmware_bytes, int garbled_uploads)
      : expected_(firmware_bytes), garbled_(garbled_uploads) {}
  Result<Identity> open(const Address&, const codec::Wire&) override { return Identity{}; }
  void close() noexcept override {}
  Status control(const codec::StartStep& step) noexcept override {
    if (step.request == 3) baud = step.value;
    if (step.request == 0) phase = 0, got = 0;
    return Status::kOk;
  }
  Status send(std::span<const uint8_t> bytes) noexcept override {
    const std::vector<uint8_t> sent(bytes.begin(), bytes.end());
    if (runs && baud == 2) {
      const std::string report = "<AAAAAAAAAAAAAAA>";
      answer(std::vector<uint8_t>(report.begin(), report.begin() + 15), '>');
    } else if (phase == 0 && baud == 0x4138 && sent == std::vector<uint8_t>{0x0a, 0x43, 0x0d}) {
      phase = 1;
      answer({0x0a, 0x44, 0x2c}, 0x0d);
    } else if (phase == 1 && baud == 0x15 && sent == std::vector<uint8_t>{0x41}) {
      phase = 2;
      answer({}, 0x41);
    } else if (phase == 2) {
      got += sent.size();
      std::vector<uint8_t> echo = sent;
      if (garbled_ > 0 && got > expected_ / 2) echo[0] ^= 1, --garbled_, ++failures;
      answer({echo.begin(), echo.end() - 1}, echo.back());
      runs = got >= expected_;
    }
    return Status::kOk;
  }
  Status receive(std::span<uint8_t> to, size_t& size, Nanoseconds) noexcept override {
    size = 0;
    if (packets_.empty()) return Status::kNothing;
    size = packets_.front().size();
    std::copy(packets_.front().begin(), packets_.front().end(), to.begin());
    packets_.pop_front();
    return Status::kOk;
  }
  int baud = 0, phase = 0, failures = 0;
  size_t got = 0;
  bool runs = false;

 private:
  void answer(std::vector<uint8_t> bytes, uint8_t last) {
    bytes.push_back(last);
    bytes.insert(bytes.begin(), {0x01, 0x60});
    packets_.push_back(bytes);
  }
  size_t expected_;
  int garbled_;
  std::deque<std::vector<uint8_t>> packets_;
};

const codec::Wire& wire() {
  static const codec::Wire it = codec::readWire(emulator::wireOf(HAPTICD_SOURCE_DIR "/config/devices/falcon.yaml"), 3);
  return it;
}

TEST(FalconLoader, UploadsAndRetriesWhenAnEchoIsWrong) {
  const std::vector<uint8_t> firmware(1000, 0x55);
  FakeFalcon falcon(firmware.size(), 2);
  const auto done = loadFalcon(falcon, wire(), firmware);
  EXPECT_TRUE(done) << done.error();
  EXPECT_TRUE(falcon.runs);
  EXPECT_EQ(falcon.failures, 2);
}

TEST(FalconLoader, LeavesARunningFalconAlone) {
  FakeFalcon falcon(1000, 0);
  falcon.runs = true;
  EXPECT_TRUE(loadFalcon(falcon, wire(), {}));
  EXPECT_EQ(falcon.got, 0u);
}

TEST(FalconLoader, SaysWhereFirmwareComesFromAndGivesUpSomeTime) {
  FakeFalcon without(1000, 0);
  EXPECT_NE(loadFalcon(without, wire(), {}).error().find("firmware: FILE"), std::string::npos);
  FakeFalcon broken(1000, 1000);
  EXPECT_NE(loadFalcon(broken, wire(), std::vector<uint8_t>(1000, 1)).error().find("20 tries"), std::string::npos);
}

}  // namespace
}  // namespace hapticd::wire_arm
