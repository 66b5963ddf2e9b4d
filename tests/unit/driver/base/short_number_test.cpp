// SPDX-License-Identifier: MIT
#include "base/short_number.hpp"

#include <gtest/gtest.h>

namespace hapticd {
namespace {

TEST(ShortNumber, RoundsAndWritesNoExponentWherePeopleWriteNone) {
  EXPECT_EQ(shortNumber(6012.4), "6010");
  EXPECT_EQ(shortNumber(1234567), "1230000");
  EXPECT_EQ(shortNumber(0.0123456), "0.0123");
  EXPECT_EQ(shortNumber(-2), "-2");
  EXPECT_EQ(shortNumber(0), "0");
}

TEST(ShortNumber, DropsTheRoundingErrorOfAProduct) {
  EXPECT_EQ(shortNumber(3 * 0.1, 7), "0.3");
  EXPECT_EQ(shortNumber(40 * 1e-3, 7), "0.04");
  EXPECT_EQ(shortNumber(500 * 1e3, 7), "500000");
}

}  // namespace
}  // namespace hapticd
