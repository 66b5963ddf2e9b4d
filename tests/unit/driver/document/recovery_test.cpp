// SPDX-License-Identifier: MIT
/// After a syntax error the rest of a file is read all the same, so that one check tells all of its problems.
#include <gtest/gtest.h>

#include <ctime>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "document/node.hpp"
#include "document/repair.hpp"

namespace hapticd::document {
namespace {

struct Told {
  std::optional<Node> root;
  Problems problems;

  /// Returns the lines of the problems.
  std::vector<int> lines() const {
    std::vector<int> all;
    for (const Problem& one : problems) all.push_back(one.place.line);
    return all;
  }
  std::string valueAt(const std::vector<std::string>& path) const {
    const Node* at = root ? &*root : nullptr;
    for (const std::string& key : path)
      at = at == nullptr ? nullptr : at->isSequence() ? &at->items.at(std::stoul(key)) : at->find(key);
    return at == nullptr ? "(nothing)" : toJson(*at);
  }
  std::string text() const { return textOf(problems); }
};

Told readAll(const std::string& text) {
  Told told;
  told.root = readOn(text, "t.yaml", told.problems);
  return told;
}

TEST(Recovery, ReadsALineAsItWasMeant) {
  struct Case {
    const char* text;
    int line;
    std::vector<std::string> path;
    const char* value;
  };
  const Case cases[] = {
      {"a:\n  b: 1\n\tc: 2\n  d: 3\n", 3, {"a", "c"}, "2"},
      {"a:\n  - b: 1\n\tc: 2\n    d: 3\n", 3, {"a", "0", "c"}, "2"},
      {"a:\n\tb: 1\n\tc: {d: 2}\n", 2, {"a", "c", "d"}, "2"},
      {"a:\n\tb:\n\t\tc: 1\n\td: 2\n", 2, {"a", "d"}, "2"},
      {"a: 1\nb 2\nc: 3\n", 2, {"b"}, "2"},
      {"a: 1\nb = 2\nc: 3\n", 2, {"b"}, "2"},
      {"a:\n  b:1\n  c: 2\n", 2, {"a", "b"}, "1"},
      {"a: {b: 1\nc: 2\n", 1, {"c"}, "2"},
      {"a: [1, 2\nc: 2\n", 1, {"a"}, "[1,2]"},
      {"a: {b: [1, 2}\nc: 2\n", 1, {"a", "b"}, "[1,2]"},
      {"a: {b: 1}}\nc: 2\n", 1, {"a", "b"}, "1"},
      {"a: {b: 1 c: 2}\n", 1, {"a", "c"}, "2"},
      {"a: \"b\nc: \"d\"\n", 1, {"a"}, "\"b\""},
      {"a: 'b\nc: 1\n", 1, {"c"}, "1"},
      {"a: {b: \"x, c: 1}\nd: 2\n", 1, {"a", "c"}, "1"},
      {"a: b: c\nd: 1\n", 1, {"a"}, "\"b: c\""},
      {"a: @b\nd: 1\n", 1, {"a"}, "\"@b\""},
      {"a: 1\n// b\nc: 2\n", 2, {"c"}, "2"},
      {"a:\n  -b: 1\n   c: 2\n", 2, {"a", "0", "c"}, "2"},
      {"a:\n  - b: 1\n    c: 2\n  d: 3\n", 4, {"a", "0", "d"}, "3"},
      {"a:\n  b: 1\n    c: 2\n", 3, {"a", "c"}, "2"},
      {"a:\n    b: 1\n  c: 2\nd: 3\n", 3, {"a", "c"}, "2"},
      {"a: \"C:\\dir\"\nb: 1\n", 1, {"a"}, "\"C:\\\\dir\""},
  };
  for (const Case& one : cases) {
    const Told told = readAll(one.text);
    EXPECT_EQ(told.lines(), std::vector<int>{one.line}) << one.text << told.text();
    EXPECT_EQ(told.valueAt(one.path), one.value) << one.text << told.text();
  }
}

TEST(Recovery, TellsSeveralErrorsOfOneFile) {
  const Told told = readAll("a: {b: 1\nc:2\nd:\n  -e: 1\n   f: \"g\nh: [1, 2}\ni: 1\ni: 2\n");
  EXPECT_EQ(told.lines(), (std::vector<int>{1, 2, 4, 5, 6, 8})) << told.text();
  EXPECT_EQ(told.valueAt({"h"}), "[1,2]") << told.text();
}

TEST(Recovery, SaysHowItReadsOn) {
  EXPECT_NE(readAll("a:\n  - b: 1\n  d: 3\n").text().find("(read on as if it were indented by 4)"), std::string::npos);
  const Told left_out = readAll("a: 1\nb: *nobody\nc: 2\n");
  EXPECT_NE(left_out.text().find("(read on without this line)"), std::string::npos) << left_out.text();
  EXPECT_EQ(left_out.valueAt({"c"}), "2");
  EXPECT_NE(readAll("a:\n\tb: 1\n\tc: 2\n\td: 3\n").text().find("tabs indent also the lines 3, 4"), std::string::npos);
}

TEST(Recovery, GivesPlacesOfTheFile) {
  const Told told = readAll("a:\n  - b: 1\n\tc: {d: 2, d: 3}\nb:1\nb: 2\n");
  ASSERT_EQ(told.problems.size(), 4u) << told.text();
  EXPECT_EQ(told.problems[2].text(), "t.yaml:3:12: d: given twice (first in line 3), expected each key once: 2 or 3");
  ASSERT_TRUE(told.root);
  EXPECT_EQ(told.root->find("b")->column, 3) << told.text();
}

TEST(Recovery, DropsWhatFollowsFromTextThatWasLeftOut) {
  Problems problems;
  report(problems, "t.yaml", 3, 1, "", "not YAML: something");
  problems.back().left_out = "plugin: *ball\n";
  report(problems, "t.yaml", 2, 3, "models[0].plugin", "missing, expected a name");
  report(problems, "t.yaml", 2, 3, "models[0].name", "missing, expected a name");
  report(problems, "t.yaml", 5, 3, "models[0].x", "unknown key, expected one of name, plugin");
  report(problems, "t.yaml", 6, 3, "models[0].path", "the plugin of this model takes no path");
  report(problems, "u.yaml", 2, 3, "models[0].plugin", "missing, expected a name");
  dropFollowUps(problems);
  std::vector<std::string> keys;
  for (const Problem& one : problems) keys.push_back(one.place.file + " " + one.key);
  EXPECT_EQ(keys, (std::vector<std::string>{"t.yaml ", "t.yaml models[0].name", "t.yaml models[0].x",
                                            "u.yaml models[0].plugin"}));
}

/// Returns how many times longer a text takes that has eight times as many parts. A time is the shortest of three.
double growth(std::string (*textOf)(int parts), int parts) {
  const auto shortest = [textOf](int count) {
    const std::string text = textOf(count);
    std::clock_t best = std::numeric_limits<std::clock_t>::max();
    for (int i = 0; i < 3; ++i) {
      const std::clock_t begun = std::clock();
      readAll(text);
      best = std::min(best, std::clock() - begun);
    }
    return static_cast<double>(best);
  };
  return shortest(8 * parts) / shortest(parts);
}

TEST(Recovery, TakesTimeInProportionToTheText) {
  constexpr double kMost = 24;  // between 8 for a time in proportion, and 64 for one that grows with the square
  EXPECT_LT(growth(
                [](int keys) {
                  std::string text;
                  for (int i = 0; i < keys; ++i) text += "same: 1\n";
                  return text;
                },
                2000),
            kMost);
  EXPECT_LT(growth(
                [](int anchors) {
                  std::string text = "a:\n", aliases;
                  for (int i = 0; i < anchors; ++i) {
                    text += "- &a" + std::to_string(i) + " x\n";
                    aliases += "- *a" + std::to_string(i) + "\n";
                  }
                  return text + "b:\n" + aliases;
                },
                2000),
            kMost);
}

TEST(Recovery, TriesFewCorrectionsOfALongLine) {
  std::string commas = "a: \"", words = "a: [";
  for (int i = 0; i < 10'000; ++i) commas += "b, ", words += "b c ";
  constexpr size_t kMost = 50;  // each is a copy of the text
  EXPECT_LT(corrections({commas}, {"", 1, 4}).size(), kMost);
  EXPECT_LT(corrections({words}, {"", 1, 4}).size(), kMost);
}

/// A text that cannot be read as it is never becomes one without a problem, whatever is broken in it.
TEST(Recovery, NeverAcceptsABrokenText) {
  const std::string good =
      "hapticd: 1\nservo: {rate: 1000, gravity: [0, 0, 0]}\nmodels:\n  - name: \"ball\"\n    plugin: torus\n"
      "    parameters:\n      ring: 0.04\n      tube: 0.01\n  - {name: 'b', plugin: c}\n";
  std::mt19937 random(7);
  const std::string breaks = "\t\n {}[]\"':,-#&*";
  std::string unread;
  size_t broken = 0, read = 0;
  for (int round = 0; round < 1500; ++round) {
    std::string text = good;
    for (int slips = 1 + static_cast<int>(random() % 3); slips > 0; --slips) {
      const size_t at = random() % text.size();
      const char with = breaks[random() % breaks.size()];
      if (random() % 2 == 0)
        text[at] = with;
      else
        text.insert(at, 1, with);
    }
    Problems strict, all;
    const bool parsed = parseText(text, "t.yaml", strict).has_value();
    const auto root = readOn(text, "t.yaml", all);
    EXPECT_EQ(strict.empty(), all.empty()) << text;
    EXPECT_TRUE(!parsed || root) << text;
    broken += parsed ? 0 : 1, read += !parsed && root ? 1 : 0;
    if (!root && !parsed) unread += text + "----\n" + textOf(all) + "====\n";
    for (const Problem& one : all) EXPECT_LE(one.place.line, 15) << text << one.text();
  }
  EXPECT_GT(broken, 500u);
  EXPECT_GT(read * 100, broken * 95) << read << " of " << broken << ", not:\n" << unread.substr(0, 4000);
}

}  // namespace
}  // namespace hapticd::document
