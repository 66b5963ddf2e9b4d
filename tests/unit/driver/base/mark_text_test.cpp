// SPDX-License-Identifier: MIT
#include "base/mark_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace hapticd {
namespace {

using namespace std::string_view_literals;

TEST(MarkText, MayHaveEveryCharacterThatIsShown) {
  for (const std::string_view text : {"a"sv, " "sv, "trial 7 \"begins\""sv, "\xc3\xa4"sv, "\xe2\x82\xac"sv,
                                      "\xf0\x9f\x96\x90"sv, "\xed\x9f\xbf"sv, "\xee\x80\x80"sv, "\xf4\x8f\xbf\xbf"sv})
    EXPECT_TRUE(isMarkText(text)) << text;
  EXPECT_TRUE(isMarkText(std::string(kMostMarkBytes, 'x')));
}

TEST(MarkText, HasABound) {
  EXPECT_FALSE(isMarkText(""));
  EXPECT_FALSE(isMarkText(std::string(kMostMarkBytes + 1, 'x')));
}

TEST(MarkText, HasNoControlCharacters) {
  for (int c = 0; c < 0x20; ++c) EXPECT_FALSE(isMarkText(std::string("a") + static_cast<char>(c))) << c;
  // DEL, the first and the last control of Latin-1, separators of lines and paragraphs, and turned directions
  for (const std::string_view text :
       {"\x7f"sv, "\xc2\x80"sv, "\xc2\x9f"sv, "\xe2\x80\xa8"sv, "\xe2\x80\xa9"sv, "\xe2\x80\xae"sv, "\xe2\x81\xa6"sv})
    EXPECT_FALSE(isMarkText(text)) << text;
  EXPECT_TRUE(isMarkText("\xc2\xa0")) << "a space of Latin-1 is none";
}

TEST(MarkText, IsUtf8) {
  // a byte that continues nothing, cut characters, overlong forms, a surrogate, a character beyond the last, Latin-1
  for (const std::string_view text :
       {"\x80"sv, "\xc3"sv, "\xe2\x82"sv, "\xf0\x9f\x96"sv, "\xc1\x81"sv, "\xe0\x81\x81"sv, "\xf0\x80\x81\x81"sv,
        "\xed\xa0\x80"sv, "\xf4\x90\x80\x80"sv, "\xff"sv, "\xe4 "sv})
    EXPECT_FALSE(isMarkText(text)) << text;
}

}  // namespace
}  // namespace hapticd
