// SPDX-License-Identifier: MIT
/// Axes whose ticks can be read, and panels in which nothing is covered or cut.
#include "record/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <regex>

namespace hapticd::record {
namespace {

TEST(Axis, HasTwoTicksAtLeastAndNoneOutside) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-9, 6), wide(0.001, 12);
  for (int i = 0; i < 20000; ++i) {
    const double low = std::pow(10, exponent(random)), high = low * std::pow(10, wide(random));
    for (const bool logarithmic : {true, false}) {
      const Axis axis = axisOver("", low, high, logarithmic);
      EXPECT_LE(axis.low, low * (1 + 1e-6));
      EXPECT_GE(axis.high, high * (1 - 1e-6));
      const auto ticks = axis.ticks(8);
      ASSERT_GE(ticks.size(), 2u) << low << " to " << high;
      EXPECT_LE(ticks.size(), 10u) << low << " to " << high;
      for (const double tick : ticks) {
        EXPECT_GE(axis.share(tick), -1e-6) << tick;
        EXPECT_LE(axis.share(tick), 1 + 1e-6) << tick;
        EXPECT_NEAR(axis.share(axis.at(axis.share(tick))), axis.share(tick), 1e-9);
      }
    }
  }
}

TEST(Axis, ShowsZeroAsZeroAndKeepsItAsAnEnd) {
  const Axis both = axisOver("", -0.3, 0.7);
  bool zero = false;
  for (const double tick : both.ticks(8)) zero = zero || tick == 0;
  EXPECT_TRUE(zero);
  EXPECT_EQ(axisOver("", 0, 17).low, 0);
  EXPECT_EQ(axisOver("", -17, 0).high, 0);
  EXPECT_GT(axisOver("", 5, 5).high, axisOver("", 5, 5).low);
}

TEST(Axis, OfOneDecadeOrLessHasMoreThanOneTick) {
  EXPECT_GE(axisOver("", 610, 690, true).ticks(14).size(), 2u);
  EXPECT_GE(axisOver("", 90, 110, true).ticks(14).size(), 2u);
}

struct Text {
  double x, y;
  std::string anchor, words;
};

std::vector<Text> textsOf(const std::string& svg) {
  static const std::regex kText("<text x=\"([-0-9.]+)\" y=\"([-0-9.]+)\" text-anchor=\"(\\w+)\"[^>]*>([^<]*)<");
  std::vector<Text> texts;
  for (std::sregex_iterator it(svg.begin(), svg.end(), kText), end; it != end; ++it)
    texts.push_back({std::stod((*it)[1]), std::stod((*it)[2]), (*it)[3], (*it)[4]});
  return texts;
}

/// Labels in the font's size of 10 to 15 pixels whose lines meet.
size_t overlaps(const std::vector<Text>& texts) {
  const auto left = [](const Text& t) {
    const double wide = 5.5 * static_cast<double>(t.words.size());
    return t.anchor == "start" ? t.x : t.anchor == "end" ? t.x - wide : t.x - wide / 2;
  };
  size_t count = 0;
  for (size_t i = 0; i < texts.size(); ++i)
    for (size_t k = 0; k < i; ++k) {
      const double wide_i = 5.5 * static_cast<double>(texts[i].words.size()),
                   wide_k = 5.5 * static_cast<double>(texts[k].words.size());
      const bool x = left(texts[i]) < left(texts[k]) + wide_k && left(texts[k]) < left(texts[i]) + wide_i;
      count += x && std::abs(texts[i].y - texts[k].y) < 10.5 ? 1 : 0;
    }
  return count;
}

TEST(Picture, CoversNoTextWithAnother) {
  Panel panel("panel", {"time [s]", 0, 10}, axisOver("[mm]", -3, 5));
  for (int i = 0; i < 9; ++i)
    panel.curves.push_back(
        {"a curve with a name " + std::to_string(i), colourOf(static_cast<size_t>(i)), {0, 10}, {0, 4}});
  for (const double at : {2.0, 2.1, 2.2, 9.9}) panel.moments.push_back({at, "device lost"});
  for (int i = 0; i < 12; ++i)
    panel.points.push_back({5 + 0.02 * i, 3, std::to_string(i + 1), "setting " + std::to_string(i)});
  panel.spans = {{1, 2, "ball", "#123456"}, {3, 4, "ball", "#123456"}};
  Picture picture("title", {600, 600});
  picture.add(panel);
  picture.add(panel);
  const auto texts = textsOf(picture.svg());
  EXPECT_GT(texts.size(), 60u);
  EXPECT_EQ(overlaps(texts), 0u);
  EXPECT_EQ(std::count_if(texts.begin(), texts.end(), [](const Text& t) { return t.words == "ball"; }), 2);
}

TEST(Picture, KeepsEveryPeakAndLiftsThePenWhereNothingIsKnown) {
  Panel panel("", {"t", 0, 1}, {"y", 0, 10});
  Curve curve{"", "#111", {}, {}};
  for (int i = 0; i < 100000; ++i) {
    curve.x.push_back(i * 1e-5);
    curve.y.push_back(i == 70000 ? 10 : i > 20000 && i < 40000 ? std::nan("") : 1);
  }
  panel.curves = {curve};
  Picture picture("", {600});
  picture.add(panel);
  const std::string svg = picture.svg();
  EXPECT_LT(svg.size(), 60000u);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  static const std::regex kLine("<polyline[^>]*points=\"([^\"]*)\"");
  size_t lines = 0;
  double highest = 1e9;
  for (std::sregex_iterator it(svg.begin(), svg.end(), kLine), end; it != end; ++it, ++lines) {
    std::stringstream points((*it)[1].str());
    for (std::string pair; points >> pair;) highest = std::min(highest, std::stod(pair.substr(pair.find(',') + 1)));
  }
  EXPECT_EQ(lines, 2u);
  EXPECT_NEAR(highest, 56, 1);  // [px] the top of the area, below title and label
}

}  // namespace
}  // namespace hapticd::record
