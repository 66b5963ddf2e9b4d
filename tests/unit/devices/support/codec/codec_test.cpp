// SPDX-License-Identifier: MIT
/// Bytes that were worked out by hand or by another formula, and properties of every type.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "codec/bits.hpp"
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

Report oneField(Type type, unsigned bits, Role role, bool big = false) {
  Field field;
  field.type = type, field.bits = static_cast<uint8_t>(bits), field.role = role, field.big_endian = big;
  std::tie(field.least, field.most) = rangeOf(type, bits);
  Report report;
  report.size = field.bytes();
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

TEST(Codec, EveryNamedCrcHasItsPublishedCheckValue) {
  const uint8_t text[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  for (const NamedCrc& named : namedCrcs()) EXPECT_EQ(checksumOf(named.check, text), named.published) << named.name;
  EXPECT_GE(namedCrcs().size(), 20u);
}

TEST(Codec, SumsAndExclusiveOrsGoByWords) {
  const uint8_t bytes[] = {0x01, 0x02, 0xff, 0x04, 0x05};
  Check check;
  EXPECT_EQ(checksumOf(check, bytes), 0x0bu);
  check.bits = 12;
  EXPECT_EQ(checksumOf(check, bytes), 0x10bu);
  check.bits = 16, check.word = 2;
  EXPECT_EQ(checksumOf(check, bytes), (0x0201u + 0x04ffu + 0x05u) & 0xffff);
  check.big_endian = true;
  EXPECT_EQ(checksumOf(check, bytes), (0x0102u + 0xff04u + 0x05u) & 0xffff);
  check.negated = true;
  EXPECT_EQ((checksumOf(check, bytes) + 0x0102u + 0xff04u + 0x05u) & 0xffff, 0u);
  Check exclusive;
  exclusive.method = Checksum::kXor, exclusive.initial = 0x5a, exclusive.final_xor = 0xff;
  EXPECT_EQ(checksumOf(exclusive, bytes), 0x5au ^ 0x01 ^ 0x02 ^ 0xff ^ 0x04 ^ 0x05 ^ 0xff);
}

TEST(Codec, AChecksumInAReportIsCompared) {
  Field field;
  field.role = Role::kChecksum, field.bits = 16, field.big_endian = true, field.check = namedCrcs()[8].check;
  ASSERT_STREQ(namedCrcs()[8].name, "crc16");
  field.from = 0, field.to = 9, field.at = 9;
  Report report;
  report.size = 11;
  report.fields = {field};
  std::vector<uint8_t> bytes = {'1', '2', '3', '4', '5', '6', '7', '8', '9', 0x29, 0xb1};
  State state;
  EXPECT_EQ(decode(report, bytes, state), Verdict::kGood);
  bytes[3] ^= 1;
  EXPECT_EQ(decode(report, bytes, state), Verdict::kCorrupt);
}

TEST(Codec, BitsStandWhereTheyAreCounted) {
  const uint8_t bytes[] = {0b1010'0110, 0b0001'1101, 0b1100'0011};
  EXPECT_EQ(getBits(bytes, 0, 24, false), 0xc31da6u);
  EXPECT_EQ(getBits(bytes, 0, 24, true), 0xa61dc3u);
  EXPECT_EQ(getBits(bytes, 4, 12, false), 0x1dau);  // the upper half of the first, then the second
  EXPECT_EQ(getBits(bytes, 4, 12, true), 0x61du);
  EXPECT_EQ(getBits(bytes, 9, 3, false), 0b110u);
  EXPECT_EQ(getBits(bytes, 9, 3, true), 0b001u);
  uint8_t room[] = {0xff, 0xff, 0xff};
  putBits(0, room, 6, 5, true);
  EXPECT_EQ(room[0], 0xfc);
  EXPECT_EQ(room[1], 0x1f);
}

TEST(Codec, NothingThatIsNoNumberPasses) {
  const Report report = oneField(Type::kFloat, 32, Role::kPosition);
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
    EXPECT_EQ(encoded(oneField(Type::kSigned, 16, Role::kTorque), order), (std::vector<uint8_t>{0, 0})) << bad;
  }
}

TEST(Codec, TorquesAreZeroWhileMotorsAreOff) {
  Order order;
  order.torque[0] = 5;
  EXPECT_EQ(encoded(oneField(Type::kSigned, 16, Role::kTorque), order), (std::vector<uint8_t>{0, 0}));
}

TEST(Codec, AReportWithTwoDifferentSequenceNumbersIsTorn) {
  Report report = oneField(Type::kUnsigned, 8, Role::kSequence);
  report.fields.push_back(report.fields[0]);
  report.fields[1].at = 1;
  report.size = 2;
  State state;
  EXPECT_EQ(decode(report, std::vector<uint8_t>{7, 7}, state), Verdict::kGood);
  EXPECT_EQ(state.sequence, 7u);
  EXPECT_EQ(decode(report, std::vector<uint8_t>{7, 6}, state), Verdict::kTorn);
}

TEST(Codec, APositionThatWrapsContinuesAtTheOtherEndOfItsType) {
  Report report = oneField(Type::kSigned, 16, Role::kPosition);
  report.fields[0].wraps = true;
  constexpr double kTurn = 65536;
  for (const double inside : {-32768.0, -5.0, 0.0, 32767.0})
    for (const double turns : {-3.0, -1.0, 0.0, 1.0, 2.0}) {
      State arm, read;
      arm.position[0] = inside + turns * kTurn;
      std::vector<uint8_t> bytes(2);
      ASSERT_EQ(encode(report, arm, bytes), 2u);
      ASSERT_EQ(decode(report, bytes, read), Verdict::kGood);
      EXPECT_EQ(read.position[0], inside) << turns;
    }
}

TEST(Codec, ReportsOfAnotherSizeOrIdAreRefused) {
  Report report = oneField(Type::kSigned, 16, Role::kPosition);
  State state;
  EXPECT_EQ(decode(report, std::vector<uint8_t>(1), state), Verdict::kWrongSize);
  EXPECT_EQ(decode(report, std::vector<uint8_t>(3), state), Verdict::kWrongSize);
  EXPECT_EQ(decode(report, {}, state), Verdict::kWrongSize);
  report.id = 4;
  EXPECT_EQ(decode(report, std::vector<uint8_t>{3, 0, 0}, state), Verdict::kWrongId);
  EXPECT_EQ(decode(report, std::vector<uint8_t>{4, 1, 0}, state), Verdict::kGood);
  EXPECT_EQ(state.position[0], 1);
}

/// The same report through escapes, whatever it holds, cut anywhere, with garbage between.
void roundTrip(const Framing& framing, size_t size, uint64_t seed) {
  std::mt19937_64 random(seed);
  Framer framer(framing, size);
  std::vector<std::vector<uint8_t>> sent, found;
  std::vector<uint8_t> stream;
  for (int i = 0; i < 200; ++i) {
    std::vector<uint8_t> report(size);
    for (uint8_t& byte : report)
      byte = random() % 3 == 0 ? framing.escape.mark : random() % 3 == 0 ? 0xc0 : static_cast<uint8_t>(random());
    if (framing.start >= 0) report.front() = static_cast<uint8_t>(framing.start);
    if (framing.end >= 0) report.back() = static_cast<uint8_t>(framing.end);
    sent.push_back(report);
    report.resize(2 * size);
    report.resize(addEscapes(framing, report, size));
    for (size_t k = 1; k + 1 < report.size(); ++k) ASSERT_TRUE(report[k] != framing.start && report[k] != framing.end);
    stream.insert(stream.end(), report.begin(), report.end());
  }
  for (size_t at = 0; at < stream.size();) {
    const size_t part = std::min<size_t>(1 + random() % 20, stream.size() - at);
    EXPECT_EQ(
        framer.take({&stream[at], part}, [&](std::span<const uint8_t> r) { found.emplace_back(r.begin(), r.end()); }),
        0u);
    at += part;
  }
  EXPECT_EQ(found, sent);
}

TEST(Framer, EscapesLetEveryReportThrough) {
  Framing hdlc, slip, one;
  hdlc.used = slip.used = one.used = hdlc.escape.used = slip.escape.used = one.escape.used = true;
  hdlc.start = hdlc.end = 0x7e, hdlc.escape.mark = 0x7d;
  slip.end = 0xc0, slip.escape.mark = 0xdb, slip.escape.count = 2;
  slip.escape.plain = {0xc0, 0xdb}, slip.escape.code = {0xdc, 0xdd};
  one.start = 0x02, one.end = 0x03, one.escape.mark = 0x10, one.escape.flip = 0x80;
  one.escape.also = {0x11, 0x13}, one.escape.also_count = 2;
  for (const Framing& framing : {hdlc, slip, one})
    for (uint64_t seed = 0; seed < 20; ++seed) roundTrip(framing, 3 + seed, seed);
}

TEST(Framer, AReportThatWasCutIsLeftOutWithEscapesToo) {
  Framing hdlc;
  hdlc.used = hdlc.escape.used = true;
  hdlc.start = hdlc.end = 0x7e, hdlc.escape.mark = 0x7d;
  Framer framer(hdlc, 5);
  const std::vector<uint8_t> stream = {9, 0x7e, 1, 2, 0x7e, 0x7e, 1, 0x7d, 0x5e, 3,   0x7e,
                                       4, 5,    6, 7, 8,    0x7e, 6, 7,    8,    0x7e};
  std::vector<std::vector<uint8_t>> found;
  const size_t lost = framer.take(stream, [&](std::span<const uint8_t> r) { found.emplace_back(r.begin(), r.end()); });
  const std::vector<std::vector<uint8_t>> expected = {{0x7e, 1, 0x7e, 3, 0x7e}, {0x7e, 6, 7, 8, 0x7e}};
  EXPECT_EQ(found, expected);
  EXPECT_GT(lost, 0u);
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
