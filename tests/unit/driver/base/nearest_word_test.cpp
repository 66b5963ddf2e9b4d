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

}  // namespace
}  // namespace hapticd
