// SPDX-License-Identifier: MIT
#include "record/contact_warnings.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "record/contact_work.hpp"

namespace hapticd::record {
namespace {

/// A model that was touched in one tick.
ModelReport touched(double depth) {
  ModelReport model;
  model.name = "ball";
  model.contact.add(true, depth, 1.5, 1e-3, 0);
  return model;
}

TEST(ContactWarnings, AreNoneForAModelThatBehaves) {
  EXPECT_TRUE(contactWarnings(touched(0.003)).empty());
}

TEST(ContactWarnings, BlameTheUnitOfAModelThatIsAsLargeAsTheDepth) {
  ModelReport model = touched(30);
  model.size_m = 75;
  const auto texts = contactWarnings(model);
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_EQ(texts[0],
            "ball is 75 m large, and the hand was 30 m deep in it, deeper than an arm reaches: lengths must be in m "
            "(75 mm is 0.075 m); check the unit of its geometry, and where it stands");
}

TEST(ContactWarnings, BlameThePluginOfASmallModel) {
  ModelReport model = touched(30);
  model.size_m = 0.1;
  const auto texts = contactWarnings(model);
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_NE(texts[0].find("test it with hapticd plugin check"), std::string::npos) << texts[0];
}

TEST(ContactWarnings, BlameTheMotionOfABodyThatRunsAway) {
  ModelReport model = touched(2e6);
  EXPECT_NE(contactWarnings(model)[0].find("depth_m must be in m"), std::string::npos) << "it stands still";
  model.moves = true;
  ASSERT_EQ(contactWarnings(model).size(), 1u);
  EXPECT_NE(contactWarnings(model)[0].find("its body runs away"), std::string::npos) << contactWarnings(model)[0];
  EXPECT_EQ(contactWarnings(model)[0].find("in mm"), std::string::npos) << contactWarnings(model)[0];
}

TEST(ContactWarnings, TellOfEnergyOnlyWhereTheModelStandsStill) {
  ModelReport model = touched(0.003);
  model.given_j = 0.02, model.taken_j = 0.01;
  ASSERT_EQ(contactWarnings(model).size(), 1u);
  EXPECT_NE(contactWarnings(model)[0].find("gave the hand 10 mJ more than it took"), std::string::npos);
  model.moves = true;
  EXPECT_TRUE(contactWarnings(model).empty());
}

TEST(ContactWork, OfAMagnetIsThatOfItsSurfaceAlone) {
  ContactWork work;  // 1 N within 20 mm of a spring of 500 N/m: the hand begins 20 mm above it, and goes 5 mm in
  for (uint64_t tick = 0; tick <= 400; ++tick) {
    const double depth = .005 - .025 * std::cos(M_PI * static_cast<double>(tick) / 800);
    work.add(tick, 1e-3, {0, depth > 0 ? 500 * depth : -1, 0}, {0, -depth, 0}, depth);
  }
  EXPECT_NEAR(work.taken(), 0.5 * 500 * .005 * .005, 1e-4);
  EXPECT_NEAR(work.given(), 0, 1e-4) << "not the 20 mJ that the hand had before the pull";
}

}  // namespace
}  // namespace hapticd::record
