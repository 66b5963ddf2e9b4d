// SPDX-License-Identifier: MIT
#include "base/nearest_word.hpp"

#include <gtest/gtest.h>

namespace hapticd {
namespace {

TEST(NearestWord, DistanceIsSymmetricAndZeroForTheSameWord) {
  const std::vector<std::string> words = {"", "a", "stiffness", "stifness", "Stiffness", "damping", "rate"};
  for (const std::string& a : words)
    for (const std::string& b : words) EXPECT_EQ(editDistance(a, b), editDistance(b, a)) << a << " " << b;
  for (const std::string& a : words) EXPECT_EQ(editDistance(a, a), 0u);
  EXPECT_EQ(editDistance("Stiffness", "stiffness"), 0u);
}

TEST(NearestWord, FindsASlipOfTheHandAndRefusesAnotherWord) {
  const std::vector<std::string> known = {"stiffness", "damping", "exponent", "geometry"};
  EXPECT_EQ(nearestWord("stifness", known), "stiffness");
  EXPECT_EQ(nearestWord("dampign", known), "damping");
  EXPECT_EQ(nearestWord("Geometry", known), "geometry");
  EXPECT_EQ(nearestWord("colour", known), "");
  EXPECT_EQ(nearestWord("", known), "");
}

}  // namespace
}  // namespace hapticd
