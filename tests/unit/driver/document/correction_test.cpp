// SPDX-License-Identifier: MIT
#include "document/correction.hpp"

#include <gtest/gtest.h>

#include "document/suggestion.hpp"

namespace hapticd::document {
namespace {

TEST(Meant, SaysHowToWriteANumberThatWasWrittenOtherwise) {
  const char* const cases[][3] = {{"0,5", "N", "; write 0.5, with a point, not a comma"},
                                  {"1,000", "N", "; write 1000, or 1.000 with a point"},
                                  {"500", "N/m", "; write 500, without quotes or a tag"},
                                  {".nan", "N/m", "; it must be finite"},
                                  {"5 N", "N", "; write 5, without the unit"},
                                  {"5Ns/m", "N s/m", "; write 5, without the unit"},
                                  {"40 mm", "m", "; write 0.04: 40 mm is 0.04 m"},
                                  {"-90°", "rad", "; write -1.570796: -90 ° is -1.570796 rad"},
                                  {"1 kHz", "Hz", "; write 1000: 1 kHz is 1000 Hz"},
                                  {"5 furlongs", "m", "; write the number alone, in m"},
                                  {"5 mm", "", "; write the number alone, in SI units"},
                                  {"50%", "", "; write 0.5: percentages are not accepted"},
                                  {"1000;", "Hz", "; write 1000, without the ; after it"},
                                  {"1'000", "Hz", "; write 1000, with nothing between the digits"},
                                  {"1000 // Hz", "Hz", "; begin a comment with a blank and #"},
                                  {"\u22129.81", "m/s^2", "; write -9.81, with the minus sign of the keyboard"},
                                  {"2pi/4096", "", "; write the result as a number: formulas are not calculated"},
                                  {"0x10", "Hz", "; write it as a decimal number"}};
  for (const auto& [text, unit, meant] : cases) EXPECT_EQ(suggestNumber(text, unit), meant) << text;
  for (const char* text : {"", "fast", "1.2.3", "10-20", "1000 2000", "1 2", "0,5,1", ",", "-", "mm", "true"})
    EXPECT_EQ(suggestNumber(text, "N"), "") << text;
  EXPECT_EQ(wrongDecimal("800,5"), "\"800,5\" is not a number; write 800.5, with a point, not a comma");
  EXPECT_EQ(wrongDecimal("800.5") + wrongDecimal("linear"), "");
}

TEST(Meant, ReadsAListInATextAndTwoNumbersInOne) {
  const auto node = [](const std::string& text) {
    Problems problems;
    return parseText(text, "t.yaml", problems).value_or(Node{});
  };
  EXPECT_EQ(suggestList(node("0 0 0.1"), 3), "; write [0, 0, 0.1]");
  EXPECT_EQ(suggestList(node("0, -9.81, 0"), 3), "; write [0, -9.81, 0]");
  EXPECT_EQ(suggestList(node("[0,5, 0, 0]"), 3),
            "; a comma separates two numbers: write decimals with a point, such as 0.5");
  EXPECT_EQ(suggestList(node("{x: 0, y: 0, z: 0}"), 3), "; write the numbers alone, as [x, y, z]");
  for (const char* text : {"[0, 0.1]", "somewhere", "0 0", "[a, b, c, d]"}) EXPECT_EQ(suggestList(node(text), 3), "");
  EXPECT_EQ(suggestMapping(node("rate = 1000")), "; write rate: 1000, with a colon and a blank");
  EXPECT_EQ(suggestMapping(node("rate:1000")), "; write rate: 1000, with a colon and a blank");
  for (const char* text : {"press", "[1]", "http://x", "a b = 1"}) EXPECT_EQ(suggestMapping(node(text)), "") << text;
}

TEST(Meant, ReadsDecimalCommasInAList) {
  const auto told = [](const std::string& text, size_t least) {
    Problems problems;
    return suggestDecimals(parseText(text, "t.yaml", problems).value_or(Node{}), least);
  };
  EXPECT_EQ(told("[0,2, 0,18, 0]", 2), "; a comma separates two numbers: write 0.2, not 0,2");
  EXPECT_EQ(told("[0,5]", 1), "; a comma separates two numbers: write 0.5, not 0,5");
  for (const char* text : {"[0,5]", "[0, 0, 0, 0]", "[1, 0, 0, 0]", "[0, 0.2, 0, 0.3]", "[0.2, 0.18]", "3", "[]"})
    EXPECT_EQ(told(text, 2), "") << text;
}

TEST(Meant, ReadsANumberInAnotherUnit) {
  EXPECT_EQ(suggestOtherUnit(1, {50, 20000}, "Hz").advice, "; 1 kHz is 1000 Hz");
  EXPECT_EQ(suggestOtherUnit(5, {1e-4, 1}, "s").advice, "; 5 ms is 0.005 s");
  EXPECT_EQ(suggestOtherUnit(5, {1e-4, 1}, "s").meant, 0.005);
  EXPECT_EQ(suggestOtherUnit(100000, {50, 20000}, "Hz").advice, "");
}

TEST(Meant, FindsTheValueInsideAKey) {
  EXPECT_EQ(suggestion("rate:1000", {"rate"}), " (no blank after the colon, expected \"rate: 1000\")");
  EXPECT_EQ(suggestion("\u00a0rate", {"rate"}), " (it contains a no-break space, expected ordinary blanks)");
  EXPECT_EQ(suggestion("5", {"rate"}), " (there is a comma before it: write decimals with a point, such as 0.5)");
  EXPECT_EQ(suggestionOfName("5", {"rate"}), "") << "a word of a command follows no comma";
  EXPECT_EQ(suggestionOfName("rte", {"rate"}), " (did you mean \"rate\"?)");
  EXPECT_EQ(suggestion("poke", {"none", "press"}), "");
}

}  // namespace
}  // namespace hapticd::document
