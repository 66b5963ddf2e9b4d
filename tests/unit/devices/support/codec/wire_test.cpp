// SPDX-License-Identifier: MIT
/// Wrong descriptions are refused with the path of the key, and shipped ones are right.
#include "codec/wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "emulators/wire_file.hpp"

namespace hapticd::codec {
namespace {

constexpr const char* kGood =
    R"({"rate":1000,"input":{"size":2,"fields":[{"is":"position","joint":1,"at":0,"type":"i16","scale":0.1}]},)"
    R"("output":{"size":2,"fields":[{"is":"torque","joint":1,"at":0,"type":"i16","scale":0.1}]}})";

std::string complaint(const std::string& json) {
  try {
    readWire(json, 1);
    return "";
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = kGood;
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Wire, AGoodDescriptionIsTaken) {
  EXPECT_EQ(complaint(kGood), "");
  EXPECT_EQ(complaint(changed(R"("at":0)", R"("at":"0x0")")), "");  // YAML scalars come as text
}

TEST(Wire, RefusesMoreFieldsThanAReportCanUse) {
  std::string buttons;
  for (int i = 0; i < 1024; ++i) buttons += R"(,{"is":"button","button":1,"at":1,"type":"u1"})";
  EXPECT_NE(complaint(changed("}]},", "}" + buttons + "]},")).find("wire.input.fields: has more than 1024 fields"),
            std::string::npos);
}

TEST(Wire, InvertedTurnsAFlagRoundWithAndWithoutABit) {
  const auto flags = [](const std::string& more) {
    return R"({"rate":1000,"input":{"size":4,"fields":[{"is":"position","joint":1,"at":0,"type":"i16","scale":0.1},)"
           R"({"is":"button","button":1,"at":2,"bit_offset":3,"type":"u1")" +
           more + R"(},{"is":"fault","at":3,"type":"u1")" + more +
           R"(}]},"output":{"size":3,"fields":[{"is":"torque","joint":1,"at":0,"type":"i16","scale":0.1},)"
           R"({"is":"enable","at":2,"bit_offset":5,"type":"u1")" +
           more + "}]}}";
  };
  for (const char* bit : {"", ",\"bit\":0"})
    for (const bool inverted : {false, true}) {
      const Wire wire = readWire(flags(std::string(bit) + (inverted ? ",\"inverted\":true" : "")), 1);
      for (int raw = 0; raw < 2; ++raw) {
        const std::vector<uint8_t> bytes{0, 0, static_cast<uint8_t>(raw << 3), static_cast<uint8_t>(raw)};
        State state;
        ASSERT_EQ(decode(wire.input, bytes, state), Verdict::kGood);
        EXPECT_EQ(state.buttons, (raw != 0) != inverted ? 1u : 0u) << bit << inverted << raw;
        EXPECT_EQ(state.fault, (raw != 0) != inverted) << bit << inverted << raw;
        std::vector<uint8_t> again(4);
        encode(wire.input, state, again);
        EXPECT_EQ(again, bytes) << bit << inverted;
        Order order;
        order.enable = raw != 0;
        std::vector<uint8_t> out(3);
        encode(wire.output, order, out);
        EXPECT_EQ(out[2], (raw != 0) != inverted ? 1 << 5 : 0) << bit << inverted << raw;
      }
    }
}

TEST(Wire, ASwitchIsNoPartOfACounter) {
  const std::string with =
      R"({"rate":1000,"input":{"size":4,"fields":[{"is":"position","joint":1,"at":0,"type":"i16"},)"
      R"({"is":"counter","at":2,"type":"u8"},{"is":"button","button":1,"at":PLACE,"type":"u8"}]},)"
      R"("output":{"size":2,"fields":[{"is":"torque","joint":1,"at":0,"type":"i16","scale":0.1}]}})";
  const auto at = [&](const char* place) { return std::string(with).replace(with.find("PLACE"), 5, place); };
  EXPECT_EQ(complaint(at("3")), "");
  EXPECT_NE(complaint(at("2")).find("fields[2].at: takes bits of byte 2, which fields[1] (counter) uses already"),
            std::string::npos)
      << complaint(at("2"));
}

TEST(Wire, EveryMistakeIsNamedByItsPath) {
  const struct {
    const char *from, *to, *expected;
  } cases[] = {
      {"i16", "i65", "wire.input.fields[0].type: \"i65\", expected one of i8"},
      {"i16", "i1", "wire.input.fields[0].type: \"i1\""},
      {"i16", "f16", "wire.input.fields[0].type: \"f16\""},
      {"i16", "u08", "wire.input.fields[0].type: \"u08\""},
      {"\"at\":0", "\"at\":1",
       "wire.input.fields[0].at: 1, so it takes the bytes 1 to 2, but wire.input.size is 2: the last byte is 1; "
       "expected size: 3 or more"},
      {"\"at\":0", "\"at\":-1", "wire.input.fields[0].at: -1"},
      {"\"joint\":1", "\"joint\":2", "wire.input.fields[0].joint: 2, expected 1"},
      {"\"position\"", "\"enable\"", "wire.input.fields[0].is: \"enable\" cannot be a field of an input report"},
      {"\"scale\":0.1", "\"scale\":0", "wire.input.fields[0].scale: 0, expected the value of one raw unit in SI units"},
      {"\"scale\":0.1", "\"scala\":1", "wire.input.fields[0].scala: unknown key"},
      {"\"size\":2", "\"size\":1", "wire.input.fields[0].type: \"i16\" takes 2 bytes, but wire.input.size is 1"},
      {"\"size\":2", "\"size\":100000", "wire.input.size: 100000"},
      {"\"rate\":1000", "\"rate\":\"fast\"", "wire.rate: \"fast\", expected a number"},
      {"\"rate\":1000", "\"rate\":1000,\"endpoints\":{\"in\":1,\"out\":2}", "wire.endpoints.in: 1"},
      {"\"rate\":1000,", "", "wire: lacks the key \"rate\""},
      {"{\"is\":\"position\",\"joint\":1,\"at\":0,\"type\":\"i16\",\"scale\":0.1}", "",
       "no position of joint 1, expected one field"},
  };
  for (const auto& c : cases)
    EXPECT_NE(complaint(changed(c.from, c.to)).find(c.expected), std::string::npos)
        << complaint(changed(c.from, c.to)) << "\n  expected: " << c.expected;
  EXPECT_NE(complaint("[").find("wire: cannot be read"), std::string::npos);
  EXPECT_NE(complaint("3").find("expected a mapping"), std::string::npos);
}

size_t lines(const std::string& text) {
  return text.empty() ? 0 : 1 + static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// What a report with these fields is told; the output has one torque.
std::string complaintOf(const std::string& fields, const std::string& torque = R"("type":"i16","scale":0.1)",
                        const std::string& more = "") {
  return complaint(R"({"rate":1000,"input":{"size":12,"fields":[)" + fields + R"(]},"output":{"size":8,"fields":[)" +
                   R"({"is":"torque","joint":1,"at":0,)" + torque + "}" + more + "]}}");
}

std::string positionAnd(const std::string& more, const std::string& place = R"("at":1,"type":"i24")") {
  return R"({"is":"position","joint":1,"scale":1,)" + place + "}" + (more.empty() ? "" : ",") + more;
}

TEST(Wire, NothingStandsOnTheBitsOfAJoint) {
  EXPECT_EQ(complaintOf(positionAnd("")), "");
  EXPECT_EQ(
      complaintOf(positionAnd(R"({"is":"button","button":1,"at":3,"type":"u8"})")),
      "wire.input.fields[1].at: takes bits of byte 3, which fields[0] (position of joint 1) uses already; correct at, "
      "bit_offset or type of one of the two fields");
  EXPECT_EQ(complaintOf(positionAnd(R"({"is":"button","button":1,"at":4,"type":"u8"})")), "");
  EXPECT_NE(
      complaintOf(R"({"is":"counter","at":0,"type":"u16"},)" + positionAnd("")).find("fields[1].at: takes bits of"),
      std::string::npos);
  EXPECT_NE(complaintOf(positionAnd(R"({"is":"velocity","joint":1,"at":3,"type":"f32"})")).find("fields[1].at"),
            std::string::npos);
  EXPECT_NE(
      complaintOf(positionAnd(""), R"("type":"i16","scale":0.1)", R"(,{"is":"enable","at":1,"bit":7,"type":"u8"})")
          .find("wire.output.fields[1].at: takes bits of byte 1"),
      std::string::npos);
}

TEST(Wire, AWatchdogThatIsSlowIsNoneForAHand) {
  const auto cutsSoon = [](const std::string& seconds) {
    return readWire(changed("\"rate\":1000", "\"rate\":1000,\"watchdog\":" + seconds), 1).cutsSoon();
  };
  EXPECT_TRUE(cutsSoon("0.1"));
  EXPECT_FALSE(cutsSoon("0.2"));
  EXPECT_FALSE(cutsSoon("0"));
}

/// A key that is renamed or removed must be so in the inputs of the fuzzers too, else they examine nothing.
TEST(Wire, TheFuzzersBeginWithDescriptionsThatAreTaken) {
  for (const char* folder : {"wire", "capture"})
    for (const auto& entry :
         std::filesystem::directory_iterator(HAPTICD_SOURCE_DIR "/tests/fuzz/corpus/" + std::string(folder))) {
      if (entry.path().filename() == "misplaced") continue;
      std::ifstream file(entry.path(), std::ios::binary);
      std::string all((std::istreambuf_iterator<char>(file)), {});
      ASSERT_FALSE(all.empty()) << entry.path();
      const auto joints = static_cast<unsigned char>(all[0]) % 32 % (kMaxJoints + 1);
      EXPECT_NO_THROW(readWire(all.substr(1, all.find('\0') - 1), joints)) << entry.path();
    }
}

TEST(Wire, AWatchdogThatIsFasterThanTheCommandsIsRefused) {
  const auto times = [](const std::string& given) { return changed("\"rate\":1000", given); };
  EXPECT_NO_THROW(readWire(times(R"("rate":1000,"watchdog":0.002)"), 1));
  EXPECT_NO_THROW(readWire(times(R"("rate":50,"watchdog":0.04)"), 1));
  try {
    (void)readWire(times(R"("rate":50,"watchdog":0.03)"), 1);
    ADD_FAILURE() << "a command each 20 ms";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("wire.watchdog: is 0.03 s"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("expected 0.04 s or more"), std::string::npos) << e.what();
  }
  const std::string wrong = complaint(times(R"("rate":900000,"watchdog":0.02)"));
  EXPECT_EQ(wrong.find("watchdog"), std::string::npos) << "of a wrong rate, nobody knows the pause: " << wrong;
}

TEST(Wire, NeighboursInOneByteAreNoOverlap) {
  const std::string twelve = R"("at":1,"type":"i12")", big = R"("at":1,"type":"i12","endian":"big")";
  const std::string low = R"({"is":"button","button":1,"at":2,"type":"u8","bit":3})",
                    high = R"({"is":"button","button":1,"at":2,"type":"u8","bit":4})";
  EXPECT_NE(complaintOf(positionAnd(low, twelve)).find("byte 2"), std::string::npos);
  EXPECT_EQ(complaintOf(positionAnd(high, twelve)), "");
  EXPECT_EQ(complaintOf(positionAnd(low, big)), "");  // which has the upper half of byte 2
  EXPECT_NE(complaintOf(positionAnd(high, big)).find("byte 2"), std::string::npos);
  EXPECT_EQ(complaintOf(positionAnd(low + "," + high, R"("at":3,"type":"i16")")), "");
}

TEST(Wire, ATorqueHasBothSigns) {
  for (const char* good : {R"("type":"i2")", R"("type":"f32","scale":-3)", R"("type":"nibbles","scale":-1e-4)",
                           R"("type":"u16","scale":0.001,"offset":-32.768)"})
    EXPECT_EQ(complaintOf(positionAnd(""), good), "") << good;
  EXPECT_EQ(complaintOf(positionAnd(""), R"("type":"u16","scale":0.001)"),
            "wire.output.fields[0].type: \"u16\" can only express 0 to 65.535 N m with this scale and offset; expected "
            "both signs: "
            "use a signed type such as i16, or an offset that puts zero in the middle");
  EXPECT_NE(complaintOf(positionAnd(""), R"("type":"i16","scale":0.001,"offset":33)").find("expected both signs"),
            std::string::npos);
}

TEST(Wire, ANumberHasOneScaleAndATorqueNoDegrees) {
  const auto position = [](const std::string& more) {
    return complaintOf(R"({"is":"position","joint":1,"at":0,"type":"i16",)" + more + "}");
  };
  EXPECT_EQ(position(R"("scale_degrees":0.0044,"offset_degrees":3)"), "");
  EXPECT_EQ(position(R"("scale":7e-5,"scale_degrees":0.0044)"),
            "wire.input.fields[0].scale_degrees: cannot be used together with scale; remove one of the two");
  EXPECT_EQ(position(R"("scale":7e-5,"offset":1,"offset_degrees":3)"),
            "wire.input.fields[0].offset_degrees: cannot be used together with offset; remove one of the two");
  EXPECT_EQ(complaintOf(positionAnd(""), R"("type":"i16","scale_degrees":0.01)"),
            "wire.output.fields[0].scale_degrees: a torque has no degrees; use scale in N m");
}

TEST(Wire, AFieldBeyondTheReportIsToldOnceAndWithTheSizeThatItNeeds) {
  const std::string said =
      complaintOf(positionAnd(R"({"is":"checksum","at":11,"type":"u16","method":"crc16-modbus","from":0,"to":11})"));
  EXPECT_EQ(
      said,
      "wire.input.fields[1].at: 11, so it takes the bytes 11 to 12, but wire.input.size is 12: the last byte is 11; "
      "expected size: 13 or more, or a smaller at");
}

TEST(Wire, AFieldBeyondAReportWithAnIdIsToldThatTheIdIsNotCounted) {
  const std::string said = complaint(
      R"({"rate":1000,"input":{"id":3,"size":4,"fields":[{"is":"position","joint":1,"at":0,"type":"i16","scale":0.1},)"
      R"({"is":"checksum","at":4,"type":"u8","method":"crc8","from":0,"to":4}]},)"
      R"("output":{"size":2,"fields":[{"is":"torque","joint":1,"at":0,"type":"i16","scale":0.1}]}})");
  EXPECT_TRUE(said.ends_with("or a smaller at; at, from, to and size do not count the id")) << said;
}

TEST(Wire, WhatOthersCallATypeOrAChecksumIsUnderstood) {
  const auto type = [](const char* text) { return complaint(changed("i16", text)); };
  EXPECT_NE(type("int24").find("nibbles (did you mean \"i24\"?)"), std::string::npos) << type("int24");
  EXPECT_NE(type("s24").find("\"i24\"?"), std::string::npos);
  EXPECT_NE(type("uint8_t").find("\"u8\"?"), std::string::npos);
  EXPECT_NE(type("float").find("\"f32\"?"), std::string::npos);
  EXPECT_EQ(type("thing").find("did you mean"), std::string::npos);
  const auto method = [](const std::string& name) {
    return complaintOf(
        positionAnd(R"({"is":"checksum","at":8,"type":"u16","from":0,"to":8,"method":")" + name + "\"}"));
  };
  for (const char* name : {"xmodem", "CRC-16/XMODEM", "crc16_xmodem", "crc16-xmoden"})
    EXPECT_NE(method(name).find("(did you mean \"crc16-xmodem\"?)"), std::string::npos) << method(name);
  EXPECT_NE(method("crc16-ccitt").find("\"crc16-ccitt-false\"?"), std::string::npos);
  EXPECT_LT(method("xmodem").size(), 200u);
  EXPECT_NE(method("md5").find("crc32-bzip2"), std::string::npos);  // nothing is near: all of them
}

TEST(Wire, AMisspeltWordIsUnderstoodInside) {
  EXPECT_NE(complaint(changed("\"scale\"", "\"scael\"")).find("(did you mean \"scale\"?)"), std::string::npos);
  EXPECT_NE(complaint(changed("\"fields\"", "\"field\"")).find("(did you mean \"fields\"?)"), std::string::npos);
  EXPECT_NE(complaint(changed("\"input\"", "\"inputs\"")).find("(did you mean \"input\"?)"), std::string::npos);
  EXPECT_NE(complaint(changed("\"position\"", "\"positon\"")).find("(did you mean \"position\"?)"), std::string::npos);
}

TEST(Wire, ABlockUnderAMisspeltKeyIsReadAsTheOneThatIsMeant) {
  std::string text = changed("\"output\"", "\"ouput\"");
  EXPECT_EQ(lines(complaint(text)), 1u) << complaint(text);
  for (size_t at = 0; (at = text.find("\"fields\"", at)) != std::string::npos;) text.replace(at, 8, "\"feilds\"");
  text.replace(text.find("i16"), 3, "i65");
  const std::string said = complaint(text);
  for (const char* expected : {"wire.ouput: unknown key", "wire.ouput.feilds: unknown key",
                               "wire.input.feilds: unknown", "wire.input.feilds[0].type: \"i65\""})
    EXPECT_NE(said.find(expected), std::string::npos) << expected << "\n  in:\n" << said;
  EXPECT_EQ(lines(said), 4u) << said;
  EXPECT_EQ(draftOfWire(text, 1).output.fields.size(), 1u);
  const auto moved = misplacedInWire(text, 1);
  ASSERT_EQ(moved.size(), 3u);
  EXPECT_EQ(moved[0].written + " " + moved[0].meant, "wire.ouput wire.output");
}

TEST(Wire, ABlockOneLevelTooDeepIsReadWhereItBelongs) {
  std::string text = kGood;
  const size_t output = text.find(",\"output\""), close = text.rfind("}", output);
  const std::string block = text.substr(output, text.rfind("}") - output);
  text.erase(output, block.size()).insert(close, block);
  EXPECT_EQ(complaint(text), "wire.input.output: belongs one level up, beside input, not inside of it");
  text.replace(text.find("\"output\":"), std::string::npos, "\"output\":null}}");  // its keys were indented no further
  EXPECT_EQ(complaint(text), "wire.input.output: belongs one level up, beside input, not inside of it");
}

TEST(Wire, AllMistakesAreToldAtOnce) {
  const std::string said = complaint(
      R"({"rat":1000,"watchdog":-1,"framing":{"start":300,"escape":{"mark":125,"codes":[[1]]}},"startup":[{"wait":99}],)"
      R"("endpoints":{"in":1},"input":{"size":8,"id":0,"fields":[{"is":"position","joint":4,"at":9,"type":"i99"},)"
      R"({"is":"checksum","at":0,"type":"u8","method":"crc16-modbus","from":0,"to":4,"initial":3},{"is":"nothing"}]},)"
      R"("output":{"size":2,"fields":[{"is":"torque","joint":1,"at":1,"type":"i16"},{"is":"enable","at":0,"type":"u4","bit":4}]}})");
  for (const char* expected :
       {"wire.rat: unknown key", "wire.watchdog: -1", "wire.framing.start: 300",
        "wire.framing.escape.codes[0]: expected a byte", "wire.startup[0].wait: 99", "wire.startup[0]: is empty",
        "wire.endpoints.in: 1", "wire.endpoints: lacks the key \"out\"", "wire.input.id: 0",
        "wire.input.fields[0].joint: 4", "wire.input.fields[0].at: 9", "wire.input.fields[0].type: \"i99\"",
        "wire.input.fields[1].type: \"u8\", expected u16",
        "wire.input.fields[1].from: 0, so the checksum covers itself",
        "wire.input.fields[1].initial: cannot be used with method: crc16-modbus, only with",
        "wire.input.fields[2].is: \"nothing\"", "wire.output.fields[0].at: 1", "wire.output.fields[1].bit: 4"})
    EXPECT_NE(said.find(expected), std::string::npos) << expected << "\n  in:\n" << said;
  EXPECT_LE(lines(said), 24u) << said;
  EXPECT_EQ(said.find("lacks the key \"rate\""), std::string::npos) << said;
}

TEST(Wire, AMisspeltKeyIsNotMissingAsWell) {
  EXPECT_EQ(lines(complaint(changed("\"rate\"", "\"rat\""))), 1u);
  const std::string low = complaint(changed("\"rate\":1000", "\"rat\":1"));
  EXPECT_NE(low.find("wire.rat: 1, expected a number from 50"), std::string::npos) << low;
  EXPECT_EQ(lines(low), 2u) << low;
}

TEST(Wire, AnIdBesideTheReportsIsToldWhereItBelongs) {
  const std::string said = complaint(changed("{\"rate\"", "{\"id\":2,\"rate\""));
  EXPECT_NE(said.find("wire.id: unknown key"), std::string::npos) << said;
  EXPECT_NE(said.find("; id belongs one level deeper, inside input or output"), std::string::npos) << said;
}

TEST(Wire, ADraftKeepsTheFieldsThatAreRight) {
  const Wire right = draftOfWire(kGood, 1);
  EXPECT_EQ(right.input.fields.at(0).scale, 0.1);
  EXPECT_EQ(right.input.fields.at(0).bits, 16);
  const std::string two = changed(R"("fields":[{"is":"position")", R"("fields":[{"is":"counter","at":7,"type":"u9x"},)"
                                                                   R"({"is":"position")");
  EXPECT_NE(complaint(two), "");
  const Wire draft = draftOfWire(two, 1);
  ASSERT_EQ(draft.input.fields.size(), 2u);  // in the order of the text, also with a wrong field
  EXPECT_EQ(draft.input.fields[1].scale, 0.1);
  EXPECT_EQ(draft.output.fields.at(0).role, Role::kTorque);
  EXPECT_EQ(draft.rate, 1000);
}

TEST(Wire, OneMistakeIsOneLine) {
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{{"i16", "i99"},
                                                                                 {"\"rate\":1000,", ""},
                                                                                 {"\"position\"", "\"positon\""},
                                                                                 {"\"size\":2", "\"size\":0"},
                                                                                 {"\"joint\":1", "\"joint\":9"},
                                                                                 {"\"scale\":0.1", "\"scale\":\"x\""},
                                                                                 {"\"at\":0,", ""}})
    EXPECT_EQ(lines(complaint(changed(from, to))), 1u) << complaint(changed(from, to));
}

TEST(Wire, AMarkIsJudgedAlthoughAnotherFieldIsWrong) {
  const std::string said = complaint(
      R"({"rate":1000,"framing":{"start":126},"input":{"size":4,"fields":[)"
      R"({"is":"position","joint":1,"at":0,"type":"i16","scale":0.1},{"is":"button","button":0,"at":3,"type":"u8"}]},)"
      R"("output":{"size":2,"fields":[{"is":"torque","joint":1,"at":0,"type":"i16","scale":0.1}]}})");
  EXPECT_NE(said.find("fields[0].at: takes bits of byte 0, where framing.start puts its mark 0x7e"), std::string::npos)
      << said;
  EXPECT_NE(said.find("fields[1].button: "), std::string::npos) << said;
}

TEST(Wire, AChecksumOverItselfIsToldAtTheKeyThatIsWrong) {
  const auto sum = [](const char* range) {
    return complaintOf(
        positionAnd(std::string(R"({"is":"checksum","at":8,"type":"u16","method":"crc16",)") + range + "}"));
  };
  EXPECT_EQ(sum(R"("from":0,"to":8)"), "");
  EXPECT_NE(sum(R"("from":0,"to":10)").find("fields[1].to: 10, so the checksum covers itself (bytes 8 to 9)"),
            std::string::npos)
      << sum(R"("from":0,"to":10)");
  EXPECT_NE(sum(R"("from":8,"to":10)").find("fields[1].from: 8, so the checksum covers itself"), std::string::npos)
      << sum(R"("from":8,"to":10)");
}

TEST(Wire, AClockWithoutAScaleIsOneLine) {
  const std::string said = complaintOf(positionAnd(R"({"is":"time","at":8,"type":"u16"})"));
  EXPECT_EQ(lines(said), 1u) << said;
  EXPECT_NE(said.find("lacks the key \"scale\", expected the length of one raw unit in s"), std::string::npos) << said;
}

TEST(Wire, EveryShippedDescriptionIsRight) {
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HAPTICD_SOURCE_DIR "/config/devices")) {
    const YAML::Node file = YAML::LoadFile(entry.path());
    if (!file["parameters"]["wire"]) continue;
    ++found;
    EXPECT_NO_THROW(readWire(emulator::wireOf(entry.path()), emulator::jointsOf(entry.path()))) << entry.path();
  }
  EXPECT_GE(found, 5);
}

}  // namespace
}  // namespace hapticd::codec
