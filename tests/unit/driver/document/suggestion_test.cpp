// SPDX-License-Identifier: MIT
#include "document/suggestion.hpp"

#include <gtest/gtest.h>

namespace hapticd::document {
namespace {

TEST(Listed, ShortensLongLists) {
  EXPECT_EQ(listed({"a", "b", "c"}, 3), "a, b, c");
  EXPECT_EQ(listed({"a", "b", "c"}, 2), "a, b, ... (3 in all)");
}

}  // namespace
}  // namespace hapticd::document
