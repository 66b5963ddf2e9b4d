// SPDX-License-Identifier: MIT
#include "document/suggestion.hpp"

#include <gtest/gtest.h>

namespace hapticd::document {
namespace {

TEST(Nearest, FindsASlipOfTheHandAndRefusesAnotherWord) {
  const std::vector<std::string> known = {"stiffness", "damping", "exponent", "geometry"};
  EXPECT_EQ(nearest("stifness", known), "stiffness");
  EXPECT_EQ(nearest("dampign", known), "damping");
  EXPECT_EQ(nearest("Geometry", known), "geometry");
  EXPECT_EQ(nearest("colour", known), "");
  EXPECT_EQ(nearest("", known), "");
}

TEST(Nearest, ShortensLongLists) {
  EXPECT_EQ(listed({"a", "b", "c"}, 3), "a, b, c");
  EXPECT_EQ(listed({"a", "b", "c"}, 2), "a, b, ... (3 in all)");
}

}  // namespace
}  // namespace hapticd::document
