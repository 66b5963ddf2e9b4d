// SPDX-License-Identifier: MIT
/// Wrong descriptions are refused with the path of the key, and shipped ones are right.
#include "codec/wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
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

TEST(Wire, EveryMistakeIsNamedByItsPath) {
  const struct {
    const char *from, *to, *expected;
  } cases[] = {
      {"i16", "i65", "wire.input.fields[0].type: \"i65\", expected one of i8"},
      {"i16", "i1", "wire.input.fields[0].type: \"i1\""},
      {"i16", "f16", "wire.input.fields[0].type: \"f16\""},
      {"i16", "u08", "wire.input.fields[0].type: \"u08\""},
      {"\"at\":0", "\"at\":1", "wire.input.fields[0].at: 1, expected a number from 0 to 0"},
      {"\"at\":0", "\"at\":-1", "wire.input.fields[0].at: -1"},
      {"\"joint\":1", "\"joint\":2", "wire.input.fields[0].joint: 2, expected a number from 1 to 1"},
      {"\"position\"", "\"enable\"", "wire.input.fields[0].is: \"enable\" in an input report"},
      {"\"scale\":0.1", "\"scale\":0", "wire.input.fields[0].scale: 0, expected the SI value"},
      {"\"scale\":0.1", "\"scala\":1", "wire.input.fields[0].scala: unknown key"},
      {"\"size\":2", "\"size\":1", "wire.input.fields[0].type: takes 2 bytes"},
      {"\"size\":2", "\"size\":100000", "wire.input.size: 100000"},
      {"\"rate\":1000", "\"rate\":\"fast\"", "wire.rate: \"fast\", expected a number"},
      {"\"rate\":1000", "\"rate\":1000,\"endpoints\":{\"in\":1,\"out\":2}", "wire.endpoints.in: 1"},
      {"\"rate\":1000,", "", "wire: lacks the key rate"},
      {"{\"is\":\"position\",\"joint\":1,\"at\":0,\"type\":\"i16\",\"scale\":0.1}", "", "0 positions of joint 1"},
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

TEST(Wire, AllMistakesAreToldAtOnce) {
  const std::string said = complaint(
      R"({"rat":1000,"watchdog":-1,"framing":{"start":300,"escape":{"mark":125,"codes":[[1]]}},"startup":[{"wait":99}],)"
      R"("endpoints":{"in":1},"input":{"size":8,"id":0,"fields":[{"is":"position","joint":4,"at":9,"type":"i99"},)"
      R"({"is":"checksum","at":0,"type":"u8","method":"crc16-modbus","from":0,"to":4,"initial":3},{"is":"nothing"}]},)"
      R"("output":{"size":2,"fields":[{"is":"torque","joint":1,"at":1,"type":"i16"},{"is":"enable","at":0,"type":"u4","bit":4}]}})");
  for (const char* expected :
       {"wire.rat: unknown key", "wire: lacks the key rate", "wire.watchdog: -1", "wire.framing.start: 300",
        "wire.framing.escape.codes[0]: expected a byte", "wire.startup[0].wait: 99", "wire.startup[0]: is empty",
        "wire.endpoints.in: 1", "wire.endpoints: lacks the key out", "wire.input.id: 0",
        "wire.input.fields[0].joint: 4", "wire.input.fields[0].at: 9", "wire.input.fields[0].type: \"i99\"",
        "wire.input.fields[1].type: \"u8\", expected u16", "wire.input.fields[1].at: lies inside",
        "wire.input.fields[1].initial: expected only with", "wire.input.fields[2].is: \"nothing\"",
        "wire.output.fields[0].at: 1", "wire.output.fields[1].bit: 4"})
    EXPECT_NE(said.find(expected), std::string::npos) << expected << "\n  in:\n" << said;
  EXPECT_LE(lines(said), 24u) << said;
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
