// SPDX-License-Identifier: MIT
/// Bytes that were worked out by hand or by another formula, and properties of every type.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "codec/framer.hpp"
#include "codec/report.hpp"
#include "emulators/wire_file.hpp"

namespace hapticd::codec {
namespace {

std::string file(const char* name) {
  return std::string(HAPTICD_SOURCE_DIR "/config/devices/") + name;
}

std::vector<uint8_t> encoded(const Report& report, const Order& order) {
  std::vector<uint8_t> bytes(report.bytes());
  EXPECT_EQ(encode(report, order, bytes), bytes.size());
  return bytes;
}

Report oneField(Type type, Role role, bool big = false) {
  Field field;
  field.type = type, field.role = role, field.big_endian = big;
  std::tie(field.least, field.most) = rangeOf(type);
  Report report;
  report.size = sizeOf(type);
  report.fields = {field};
  return report;
}

TEST(Codec, FalconNibblesAreWrittenLowestFirst) {
  const Wire wire = readWire(emulator::wireOf(file("falcon.yaml")), 3);
  const char text[] = "<EDCBAAAAPPPPAAA>";  // 0x1234, 0, -1
  const std::vector<uint8_t> bytes(text, text + 16);
  auto whole = bytes;
  whole[15] = '>';
  State state;
  ASSERT_EQ(decode(wire.input, whole, state), Verdict::kGood);
  const double degree = M_PI / 180, count = 0.01425 * M_PI / (320 * 4) / (M_PI * 0.110 / 360) * degree;
  EXPECT_NEAR(state.position[0], 0x1234 * count + 35 * degree, 1e-12);
  EXPECT_NEAR(state.position[1], 35 * degree, 1e-12);
  EXPECT_NEAR(state.position[2], -count + 35 * degree, 1e-12);
  EXPECT_FALSE(state.calibrated);
  whole[13] = 'B';
  ASSERT_EQ(decode(wire.input, whole, state), Verdict::kGood);
  EXPECT_TRUE(state.calibrated);
}

TEST(Codec, FalconCommandsAreTextBetweenMarks) {
  const Wire wire = readWire(emulator::wireOf(file("falcon.yaml")), 3);
  Order order;
  order.enable = true;
  order.torque = {-0.1, 0, 10};  // 1000 = 0x3e8; clamped to -4096 = 0xf000
  const auto bytes = encoded(wire.output, order);
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "<IODAAAAAAAAPAA>");
}

TEST(Codec, WoodenHapticsReportsAreSevenLittleEndianNumbers) {
  const Wire wire = readWire(emulator::wireOf(file("woodenhaptics.yaml")), 3);
  std::vector<uint8_t> bytes(14, 0);
  bytes[0] = 0xd0, bytes[1] = 0x07;  // 2000 counts: one motor turn
  bytes[4] = 0xff, bytes[5] = 0xff;
  State state;
  ASSERT_EQ(decode(wire.input, bytes, state), Verdict::kGood);
  EXPECT_NEAR(state.position[0], -2 * M_PI * 10 / 160, 1e-12);
  EXPECT_NEAR(state.position[2], 2 * M_PI / 2000 * 10 / 120, 1e-12);
  Order order;
  order.enable = true;
  order.torque = {0.0259 * 16, 0, 100};  // 1 A; more than 2 A
  const auto sent = encoded(wire.output, order);
  EXPECT_EQ(static_cast<int16_t>(sent[0] | sent[1] << 8), -1000);
  EXPECT_EQ(static_cast<int16_t>(sent[4] | sent[5] << 8), -2000);
}

TEST(Codec, Crc16HasThePublishedCheckValue) {
  Field field;
  field.role = Role::kChecksum, field.type = Type::kU16, field.method = Checksum::kCrc16;
  field.from = 0, field.to = 9, field.at = 9;
  Report report;
  report.size = 11;
  report.fields = {field};
  std::vector<uint8_t> bytes = {'1', '2', '3', '4', '5', '6', '7', '8', '9', 0xb1, 0x29};
  State state;
  EXPECT_EQ(decode(report, bytes, state), Verdict::kGood);
  bytes[3] ^= 1;
  EXPECT_EQ(decode(report, bytes, state), Verdict::kCorrupt);
}

TEST(Codec, EveryTypeComesBackAsItWasSent) {
  std::mt19937_64 random(7);
  for (const Type type : {Type::kI8, Type::kI16, Type::kI32, Type::kU8, Type::kU16, Type::kU32, Type::kF32, Type::kF64,
                          Type::kNibble, Type::kNibbles})
    for (const bool big : {false, true})
      for (int i = 0; i < 200; ++i) {
        const auto [least, most] = rangeOf(type);
        const double wanted = std::clamp(
            std::nearbyint(std::uniform_real_distribution<double>(-1, 1)(random) * std::min(most, 4294967295.0)), least,
            most);
        Order order;
        order.enable = true;
        order.torque[0] = type == Type::kF32 ? static_cast<double>(static_cast<float>(wanted)) : wanted;
        const auto bytes = encoded(oneField(type, Role::kTorque, big), order);
        State state;
        ASSERT_EQ(decode(oneField(type, Role::kTorque, big), bytes, state), Verdict::kGood);
        ASSERT_EQ(state.torque[0], order.torque[0]) << "type " << static_cast<int>(type);
      }
}

TEST(Codec, NothingThatIsNoNumberPasses) {
  const Report report = oneField(Type::kF32, Role::kPosition);
  State state;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<uint8_t> bytes(4);
    std::memcpy(bytes.data(), &bad, 4);
    EXPECT_EQ(decode(report, bytes, state), Verdict::kCorrupt);
  }
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    Order order;
    order.enable = true;
    order.torque[0] = bad;
    EXPECT_EQ(encoded(oneField(Type::kI16, Role::kTorque), order), (std::vector<uint8_t>{0, 0})) << bad;
  }
}

TEST(Codec, TorquesAreZeroWhileMotorsAreOff) {
  Order order;
  order.torque[0] = 5;
  EXPECT_EQ(encoded(oneField(Type::kI16, Role::kTorque), order), (std::vector<uint8_t>{0, 0}));
}

TEST(Codec, ReportsOfAnotherSizeOrIdAreRefused) {
  Report report = oneField(Type::kI16, Role::kPosition);
  State state;
  EXPECT_EQ(decode(report, std::vector<uint8_t>(1), state), Verdict::kWrongSize);
  EXPECT_EQ(decode(report, std::vector<uint8_t>(3), state), Verdict::kWrongSize);
  EXPECT_EQ(decode(report, {}, state), Verdict::kWrongSize);
  report.id = 4;
  EXPECT_EQ(decode(report, std::vector<uint8_t>{3, 0, 0}, state), Verdict::kWrongId);
  EXPECT_EQ(decode(report, std::vector<uint8_t>{4, 1, 0}, state), Verdict::kGood);
  EXPECT_EQ(state.position[0], 1);
}

TEST(Framer, FindsReportsHoweverTheyAreCutAndWhateverCameBefore) {
  Framing framing;
  framing.used = true, framing.header = 2, framing.packet = 8, framing.start = '<', framing.end = '>';
  const std::string stream = "xx<abc><d<f><gh<ijk>";  // "<d<f>" is a report; "<gh<i" is none, "<ijk>" is
  for (size_t cut = 1; cut < stream.size(); ++cut) {
    Framer framer(framing, 5);
    std::string found;
    const auto feed = [&](const std::string& part) {
      for (size_t at = 0; at < part.size(); at += 6) {  // six of our bytes a packet of eight
        std::vector<uint8_t> packet = {1, 0x60};
        for (const char c : part.substr(at, 6)) packet.push_back(static_cast<uint8_t>(c));
        framer.take(packet, [&](std::span<const uint8_t> r) { found += std::string(r.begin(), r.end()); });
      }
    };
    feed(stream.substr(0, cut));
    feed(stream.substr(cut));
    EXPECT_EQ(found, "<abc><d<f><ijk>") << cut;
  }
}

}  // namespace
}  // namespace hapticd::codec
