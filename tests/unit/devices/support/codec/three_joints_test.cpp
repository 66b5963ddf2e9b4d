// SPDX-License-Identifier: MIT
/// What is told of the wire format of an arm with three joints when one of its fields is wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "codec/wire.hpp"

namespace hapticd::codec {
namespace {

size_t lines(const std::string& text) {
  return text.empty() ? 0 : 1 + static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Fields of an arm with three joints and a button; the text of one of them is replaced.
std::string arm(const std::string& from, const std::string& to, const std::string& more = "") {
  std::string text =
      R"({"rate":1000,"input":{"size":9,"fields":[{"is":"position","joint":1,"at":0,"type":"i16","scale":0.1},)"
      R"({"is":"position","joint":2,"at":2,"type":"i16","scale":0.1},{"is":"position","joint":3,"at":4,"type":"i16","scale":0.1},)"
      R"({"is":"button","button":1,"at":6,"type":"u8"},{"is":"checksum","at":7,"type":"u16","method":"crc16","from":0,"to":7})" +
      more +
      R"(]},"output":{"size":6,"fields":[{"is":"torque","joint":1,"at":0,"type":"i16","scale":0.1},)"
      R"({"is":"torque","joint":2,"at":2,"type":"i16","scale":0.1},{"is":"torque","joint":3,"at":4,"type":"i16","scale":0.1}]}})";
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// Returns what is wrong with an arm with three joints.
std::string wrongOfThree(const std::string& json) {
  try {
    readWire(json, 3);
    return "";
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

TEST(Wire, AFieldThatIsTooWideIsToldAtItsTypeAndNotAtTheFieldsInIt) {
  const std::string exchanged = wrongOfThree(arm(R"("at":0,"type":"i16")", R"("at":0,"type":"i61")"));
  EXPECT_NE(exchanged.find("fields[0].type: \"i61\" takes the bytes 0 to 7, but fields[1] (position of joint 2) begins "
                           "at byte 2 (the first of 4 fields in it); expected a narrower type (did you mean \"i16\"?)"),
            std::string::npos)
      << exchanged;
  EXPECT_EQ(lines(exchanged), 1u) << exchanged;
  const std::string last = wrongOfThree(arm(R"("at":4,"type":"i16")", R"("at":4,"type":"i61")"));
  EXPECT_EQ(lines(last), 1u) << last;  // the report has no so many bytes
  const std::string wide = wrongOfThree(arm(R"("at":2,"type":"i16")", R"("at":2,"type":"i40")"));
  EXPECT_NE(wide.find("fields[1].type: \"i40\""), std::string::npos) << wide;
  EXPECT_EQ(lines(wide), 1u) << wide;
  const std::string place = wrongOfThree(arm(R"("at":4,"type":"i16")", R"("at":5,"type":"i16")"));
  EXPECT_EQ(place.find("type"), place.find("type of one of the two")) << place;  // a place is as likely
}

TEST(Wire, AChecksumOfAnOddWidthHasTheTypeOfItsMethod) {
  const std::string wide = arm(R"("type":"u16","method":"crc16")", R"("type":"u61","method":"crc16")");
  EXPECT_THROW(readWire(wide, 3), std::invalid_argument);
  try {
    readWire(wide, 3);
  } catch (const std::invalid_argument& e) {
    EXPECT_EQ(std::string(e.what()), "wire.input.fields[4].type: \"u61\", expected u16 for crc16");
  }
  EXPECT_TRUE(draftOfWire(wide, 3).input.placed);
}

TEST(Wire, OneWrongFieldHidesNoOtherProblem) {
  ASSERT_EQ(wrongOfThree(arm("\"at\":0", "\"at\":0")), "");
  // A field that is no position cannot be the missing one, and a second field of a joint is told beside it.
  const std::string twice = R"("joint":1,"at":2,"type":"i16")";
  std::string both = arm(R"("joint":2,"at":2,"type":"i16")", twice);
  both.replace(both.find(R"("button":1)"), 10, R"("button":0)");
  for (const char* words : {"fields[3].button: ", "fields[1].joint: 1, but fields[0] is", "no position of joint 2"})
    EXPECT_NE(wrongOfThree(both).find(words), std::string::npos) << words << "\n" << wrongOfThree(both);
  // Fields overlap, although the size is wrong or another field is.
  for (const auto& [right, wrong] :
       {std::pair{R"("size":9)", R"("size":"x")"}, std::pair{R"("button":1)", R"("button":0)"}}) {
    std::string overlap = arm(R"("joint":2,"at":2)", R"("joint":2,"at":1)");
    overlap.replace(overlap.find(right), std::string(right).size(), wrong);
    EXPECT_NE(wrongOfThree(overlap).find("fields[1].at: takes bits of byte 1, which fields[0] (position of joint 1)"),
              std::string::npos)
        << wrongOfThree(overlap);
  }
  // A position of an unknown joint may be the missing one: one mistake is one line.
  EXPECT_EQ(lines(wrongOfThree(arm("\"joint\":2", "\"joint\":9"))), 1u)
      << wrongOfThree(arm("\"joint\":2", "\"joint\":9"));
  // A number is not judged by the range of a type that is unknown.
  EXPECT_EQ(lines(wrongOfThree(arm("\"at\":7,\"type\":\"u16\"", "\"at\":7,\"type\":\"uint16\""))), 1u);
  EXPECT_EQ(lines(wrongOfThree(
                arm("\"rate\":1000", "\"rate\":1000", R"(,{"is":"constant","at":8,"type":"word","value":40000})"))),
            1u);
}

}  // namespace
}  // namespace hapticd::codec
