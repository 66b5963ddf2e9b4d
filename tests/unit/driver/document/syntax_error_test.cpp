// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <random>

#include "document/node.hpp"
#include "document/yaml_scan.hpp"

namespace hapticd::document {
namespace {

std::string told(const std::string& text) {
  Problems problems;
  EXPECT_FALSE(parseText(text, "t.yaml", problems)) << text;
  return problems.size() == 1 ? problems.front().text() : std::to_string(problems.size()) + " problems";
}

TEST(Slip, NamesTheBracketOrTheQuoteThatIsOpen) {
  EXPECT_EQ(told("a: {b: 1\nc: []\n"), "t.yaml:1:4: not YAML: the { that begins here is never closed, expected }");
  EXPECT_EQ(told("a: {b: [1, 2}\n"),
            "t.yaml:1:13: not YAML: the } comes while the [ of line 1, column 8 is open, expected ] before it");
  EXPECT_EQ(told("a: {b: 1}}\n"),
            "t.yaml:1:10: not YAML: the } closes nothing; remove it, or add the bracket that it closes");
  EXPECT_EQ(told("a: \"b\nc: 1\n"),
            "t.yaml:1:4: not YAML: the \" that begins here is never closed, expected the closing one");
  EXPECT_EQ(told("a: 'it''s\nc: 1\n"),
            "t.yaml:1:4: not YAML: the ' that begins here is never closed, expected the closing one");
  EXPECT_EQ(
      told("a: \"b\nc: \"d\"\n"),
      "t.yaml:1:4: not YAML: the \" that begins here is closed only in line 2, expected the closing quote in line 1");
}

TEST(Slip, SaysWhatWasMeantInPlainWords) {
  const char* const cases[][2] = {
      {"a: 1\n// b\nc: 2\n", "2:1: not YAML: // begins no comment, expected #"},
      {"a:\n  -b: 1\n   c: 2\n", "2:4: not YAML: no blank after the dash, expected \"- b: ...\""},
      {"a: @b\n", "1:4: not YAML: a text cannot begin with @, expected it in quotes"},
      {"a: *b\n", "a text that begins with * stands for one marked with &"},
      {"a: \"C:\\devices\"\n", "expected / in a path, or '...' around the text"},
      {"a: b: c\n", "1:5: not YAML: a second colon in this line"},
      {"a: {b: 1 c: 2}\n", "no comma between this and what stands before it"}};
  for (const auto& [text, words] : cases) EXPECT_NE(told(text).find(words), std::string::npos) << text << told(text);
}

TEST(Slip, ReadsOnAfterAnUnknownAlias) {
  Problems problems;
  const auto root = parseText("a: &base {x: 1}\nb:\n  <<: *bass\n  y: 2\nc: 1\nc: 2\n", "t.yaml", problems);
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[0].text().find("there is no &bass (did you mean *base?)"), std::string::npos)
      << problems[0].text();
  EXPECT_NE(problems[1].text().find("given twice"), std::string::npos) << problems[1].text();
  ASSERT_TRUE(root);
  EXPECT_NE(root->find("b")->find("x"), nullptr);
  Problems in_comments;  // names that mark nothing
  EXPECT_FALSE(parseText("# &bas1 &bas2\na: *bas3\n", "t.yaml", in_comments));
  EXPECT_LT(in_comments.size(), 12u);
}

TEST(Slip, ReadsOnInLatin1) {
  Problems problems;
  parseText("a: gr\xfcn\nb:\n\tc: 1\n", "t.yaml", problems);
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[0].text().find("1:6: a byte that is not text (code 252)"), std::string::npos)
      << problems[0].text();
  EXPECT_NE(problems[1].text().find("a tab"), std::string::npos) << problems[1].text();
  Problems binary;
  EXPECT_FALSE(parseText(std::string("a: \x01\x02\xff\n"), "t.yaml", binary));
  EXPECT_EQ(binary.size(), 1u);
}

TEST(Slip, LeavesGoodTextsAlone) {
  const char* const good[] = {"a: it's 5 o'clock\n",
                              "a: \"x\\\"y\"\nb: 'it''s'\n",
                              "a: |\n  say \"so\n  [x\nb: 1\n",
                              "a: \"two\n  lines\"\nb: 1\n",
                              "# don't \"\na: 1\n",
                              "a: b # \"c\n",
                              "a: [\"[\", '}']\n",
                              "{\"a\":\"b\"}\n",
                              "a: >-\n\n  'x\n\n  y\nb: [1]\n",
                              "a: !!str \"x\"\nb: &n 'y'\n",
                              "- - \"a\"\n  - 'b'\n",
                              "a: b\"c\n"};
  for (const char* text : good) {
    Problems problems;
    EXPECT_TRUE(parseText(text, "t.yaml", problems)) << text;
    EXPECT_TRUE(problems.empty()) << text << problems.front().text();
    const Scan scan = scanYaml(text);
    EXPECT_TRUE(scan.open.empty() && !scan.quote && !scan.wrong_close) << text;
  }
}

TEST(Slip, OfAnyTextIsToldOnceAndWithinIt) {
  std::mt19937 random(5);
  const std::string parts[] = {"a", ": ", "\n", "  ", "- ", "[", "]", "{", "}", "\"",
                               "'", "#",  "|",  "\\", ",",  "&", "*", "1", ":", "!"};
  for (int round = 0; round < 20000; ++round) {
    std::string text;
    for (unsigned n = random() % 30; n > 0; --n) text += parts[random() % std::size(parts)];
    Problems problems;
    const auto root = parseText(text, "t.yaml", problems);
    ASSERT_TRUE(root || problems.size() >= 1) << text;
    for (const Problem& problem : problems) {
      ASSERT_GE(problem.place.line, 1) << text;
      ASSERT_LE(problem.place.line, 2 + static_cast<int>(std::count(text.begin(), text.end(), '\n'))) << text;
    }
  }
}

}  // namespace
}  // namespace hapticd::document
