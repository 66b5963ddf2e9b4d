// SPDX-License-Identifier: MIT
/// The marks of framing stand in every report that goes out, whether or not the file repeats them as constants.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "codec/framer.hpp"
#include "codec/wire.hpp"

namespace hapticd::codec {
namespace {

/// An arm of one joint in bytes 1 and 2 of four, with the fields that each report has besides.
std::string format(const std::string& framing, const std::string& in = "", const std::string& out = "",
                   const std::string& head = "") {
  const auto report = [&](const char* role, const std::string& more) {
    return "{" + head + R"("size":4,"fields":[{"is":")" + role + R"(","joint":1,"at":1,"type":"i16","scale":0.001})" +
           (more.empty() ? "" : ",") + more + "]}";
  };
  return R"({"rate":1000,"framing":)" + framing + R"(,"input":)" + report("position", in) + R"(,"output":)" +
         report("torque", out) + "}";
}

std::string complaint(const std::string& json) {
  try {
    readWire(json, 1);
    return "";
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

std::vector<uint8_t> sent(const Wire& wire, double torque) {
  Order order;
  order.enable = true;
  order.torque[0] = torque;
  std::vector<uint8_t> bytes(2 * wire.output.bytes());
  bytes.resize(addEscapes(wire.framing, bytes, encode(wire.output, order, bytes)));
  return bytes;
}

constexpr const char* kEscaped = R"({"start":126,"end":126,"escape":{"mark":125}})";

TEST(Marks, AreWrittenWithoutAConstant) {
  const Wire wire = readWire(format(kEscaped), 1);
  EXPECT_EQ(sent(wire, 0.126), (std::vector<uint8_t>{0x7e, 0x7d, 0x5e, 0x00, 0x7e}));
  State state;
  state.position[0] = 0.126;
  std::vector<uint8_t> bytes(2 * wire.input.bytes());
  bytes.resize(addEscapes(wire.framing, bytes, encode(wire.input, state, bytes)));
  EXPECT_EQ(bytes, (std::vector<uint8_t>{0x7e, 0x7d, 0x5e, 0x00, 0x7e}));
  int found = 0;
  Framer(wire.framing, wire.input.bytes()).take(bytes, [&](std::span<const uint8_t> report) {
    State read;
    EXPECT_EQ(decode(wire.input, report, read), Verdict::kGood);
    EXPECT_DOUBLE_EQ(read.position[0], 0.126);
    ++found;
  });
  EXPECT_EQ(found, 1);
}

TEST(Marks, AreWrittenWithoutEscapesToo) {
  EXPECT_EQ(sent(readWire(format(R"({"start":60,"end":62})"), 1), 0.126), (std::vector<uint8_t>{60, 0x7e, 0, 62}));
  EXPECT_EQ(sent(readWire(format(R"({"start":60})"), 1), 0.126), (std::vector<uint8_t>{60, 0x7e, 0, 0}));
}

TEST(Marks, AChecksumCoversTheMark) {
  const char* sum = R"({"is":"checksum","at":3,"type":"u8","method":"sum","from":0,"to":3})";
  EXPECT_EQ(sent(readWire(format(R"({"start":60})", sum, sum), 1), 0.001), (std::vector<uint8_t>{60, 1, 0, 61}));
}

TEST(Marks, AConstantMayRepeatThem) {
  const char* same =
      R"({"is":"constant","at":0,"type":"u8","value":126},{"is":"constant","at":3,"type":"u4","value":14})";
  const Wire wire = readWire(format(kEscaped, same, same), 1);
  EXPECT_EQ(sent(wire, 0.001), (std::vector<uint8_t>{0x7e, 1, 0, 0x7e}));
}

TEST(Marks, AFieldThatContradictsThemIsRefused) {
  const char* other = R"({"is":"constant","at":0,"type":"u8","value":165})";
  EXPECT_NE(complaint(format(R"({"start":166})", other))
                .find("wire.input.fields[1].value: is 0xa5 in byte 0, where framing.start puts its mark 0xa6"),
            std::string::npos);
  EXPECT_NE(complaint(format(kEscaped, "", other)).find("wire.output.fields[1].value: is 0xa5 in byte 0"),
            std::string::npos);
  EXPECT_NE(complaint(format(kEscaped, R"({"is":"fault","at":3,"type":"u8","bit":0})"))
                .find("wire.input.fields[1].at: takes bits of byte 3, where framing.end puts its mark 0x7e"),
            std::string::npos);
  EXPECT_NE(complaint(format(kEscaped, "", "", R"("id":5,)")).find("wire.input.id: 5 is the report id"),
            std::string::npos);
  EXPECT_NE(complaint(format(kEscaped, other, "", R"("id":5,)"))
                .find("wire.input.fields[1].value: is 0xa5 in the first byte after the id"),
            std::string::npos);
}

/// Without escapes nothing reads the head of a command: an arm may want another one than it sends.
TEST(Marks, ACommandWithoutEscapesMayHaveAHeadOfItsOwn) {
  const char* other = R"({"is":"constant","at":0,"type":"u8","value":165})";
  EXPECT_EQ(sent(readWire(format(R"({"start":60})", "", other), 1), 0.001), (std::vector<uint8_t>{165, 1, 0, 0}));
}

}  // namespace
}  // namespace hapticd::codec
