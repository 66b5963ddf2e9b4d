// SPDX-License-Identifier: MIT
#include "document/node.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/catalog.hpp"
#include "scene/load.hpp"

namespace hapticd::document {
namespace {

Node parsed(const std::string& text) {
  Problems problems;
  const auto node = parseText(text, "t.yaml", problems);
  EXPECT_TRUE(problems.empty()) << problems.front().text();
  return node.value_or(Node{});
}

TEST(Number, ReadsWhatYamlCallsANumberAndNothingElse) {
  EXPECT_EQ(toNumber("1"), 1);
  EXPECT_EQ(toNumber("+1.5e-3"), 1.5e-3);
  EXPECT_EQ(toNumber("-.5"), -0.5);
  EXPECT_TRUE(std::signbit(*toNumber("-0")));
  EXPECT_TRUE(std::isnan(*toNumber(".nan")));
  EXPECT_EQ(toNumber("-.inf"), -INFINITY);
  EXPECT_EQ(toNumber("1e400"), INFINITY);
  for (const char* text :
       {"", "+", "-", ".", "1 ", " 1", "1x", "0x10", "1_0", "nan", "inf", "1,5", "--1", "+-1", "1e", "e5"})
    EXPECT_FALSE(toNumber(text)) << text;
}

TEST(Node, KnowsItsPlace) {
  const Node root = parsed("a: 1\nlist:\n  - x\n  - {b: 2}\n");
  EXPECT_EQ(root.find("list")->items[1].find("b")->line, 4);
  EXPECT_EQ(root.find("list")->items[1].find("b")->column, 9);
  EXPECT_EQ(root.entries[0].key.column, 1);
}

TEST(Node, TellsAQuotedTextFromANumber) {
  const Node root = parsed("[1, '1', \"1\", !!str 1, null, ~, 'null']");
  EXPECT_FALSE(root.items[0].quoted);
  for (const size_t i : {1, 2, 3}) EXPECT_TRUE(root.items[i].quoted) << i;
  EXPECT_TRUE(root.items[4].isNull());
  EXPECT_TRUE(root.items[5].isNull());
  EXPECT_TRUE(root.items[6].isScalar());
}

TEST(Node, ExpandsAliases) {
  const Node root = parsed("a: &x {k: [1, 2]}\nb: *x\nc: [*x, *x]\n");
  EXPECT_EQ(toJson(root), R"({"a":{"k":[1,2]},"b":{"k":[1,2]},"c":[{"k":[1,2]},{"k":[1,2]}]})");
}

TEST(Node, KeepsTheValuesOfEqualKeysToBeJudged) {
  Problems problems;
  const auto root = parseText("a: 1\na: 2\nb: {x: 1, y: 2}\nb: {x: 3, z: 4}\nc: [1]\nc: 5\n", "t.yaml", problems);
  ASSERT_TRUE(root);
  ASSERT_EQ(problems.size(), 3u);
  EXPECT_EQ(problems[0].text(), "t.yaml:2:1: a: given twice (first in line 1), expected each key once: 1 or 2");
  EXPECT_EQ(problems[1].text(), "t.yaml:4:1: b: given twice (first in line 3), expected each key once");
  EXPECT_EQ(problems[2].text(), "t.yaml:6:1: c: given twice (first in line 5), expected each key once");
  EXPECT_EQ(toJson(*root), R"({"a":1,"b":{"x":1,"y":2,"z":4},"c":[1]})") << "the first value counts";
  ASSERT_EQ(root->find("b")->entries.size(), 4u) << "the second x is judged, too";
  EXPECT_EQ(root->find("b")->entries[2].value.line, 4);
}

TEST(Node, MergesMappingsBelowItsOwnKeys) {
  const Node root = parsed("a: &a {x: 1, y: 2}\nb: &b {y: 3, z: 4}\nc: {<<: [*a, *b], x: 5}\nd: {\"<<\": 6}\n");
  const Node& both = *root.find("c");
  EXPECT_EQ(toJson(both), "{\"x\":5,\"y\":2,\"z\":4}");
  EXPECT_EQ(both.find("z")->line, 2);
  EXPECT_EQ(toJson(*root.find("d")), "{\"<<\":6}");
  Problems problems;
  parseText("c: {<<: 5}\n", "t.yaml", problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].text(),
            "t.yaml:1:9: <<: 5, expected a mapping to merge, such as an alias (*name) of one, or a list of them");
}

TEST(Node, RefusesAliasesOfAliasesAfterFewValues) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string alias = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + alias;
    for (int k = 0; k < 7; ++k) text += ", " + alias;
    text += "]\n";
  }
  Problems problems;
  EXPECT_FALSE(parseText(text, "t.yaml", problems).has_value());
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].what.find("aliases expanded"), std::string::npos);
  EXPECT_LT(problems[0].place.line, 6);
}

TEST(Node, BecomesJsonWithEverythingThatYamlSpellsOtherwise) {
  EXPECT_EQ(toJson(parsed("{a: 007, b: .5, c: 1., d: +1, e: yes, f: true, g: \"q\\\"\\n\", h: ~, i: .nan, j: 1e3}")),
            R"({"a":7,"b":0.5,"c":1,"d":1,"e":"yes","f":true,"g":"q\")"
            "\\u000a"
            R"(","h":null,"i":".nan","j":1e3})");
}

/// The texts are short, because a damaged text is parsed again with each correction that may be meant, some thirty
/// times. Of five short texts as many different problems are told as of one text that has all in it, in a third of the
/// time.
TEST(Parse, SaysOfAnEmptyFileThatItIsEmptyWhateverItsName) {
  for (const char* file : {"a.yaml", "a.hpart", "a.step"}) {
    Problems problems;
    EXPECT_FALSE(parseText("", file, problems));
    ASSERT_FALSE(problems.empty());
    EXPECT_NE(problems.front().what.find("the file is empty"), std::string::npos) << problems.front().what;
  }
}

TEST(Parse, NeverCrashesOnDamagedText) {
  const std::string good[] = {"hapticd: 1\nservo: {rate: 1000, velocity: {estimator: window}}\n",
                              "hapticd: 1\nmodels:\n  - name: &n \"a\\u0041b\"\n    plugin: x\n  - *n\n",
                              "models:\n  - plugin: x\n    pose: {position: [0, 1e-3, .inf]}\n",
                              "models:\n  - parameters: |\n      text\n    name: 'b'\n",
                              "hapticd: 1\n? [q]\n: !!map {a: 'b'}\nmodels: []\n"};
  host::Catalog none(host::SearchPath{});
  std::mt19937 random(7);
  const std::string odd = "[]{}:,&*!|>'\"%@`#-?\n\t \x01\xff~<=";
  for (int round = 0; round < 21000; ++round) {
    std::string text = good[static_cast<size_t>(round) % std::size(good)];
    for (unsigned edits = 1 + random() % 4; edits > 0; --edits) {
      const size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = odd[random() % odd.size()];
          break;
        case 1:
          text.insert(at, 1, odd[random() % odd.size()]);
          break;
        case 2:
          text.erase(at, 1 + random() % 8);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 12));
          break;
      }
      if (text.empty()) text.assign(1, ' ');
    }
    for (const Problem& problem : scene::checkText(text, "t.yaml", none)) ASSERT_FALSE(problem.what.empty());
  }
}

}  // namespace
}  // namespace hapticd::document
