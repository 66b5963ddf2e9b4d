// SPDX-License-Identifier: MIT
/// Tests which growth of memory counts as a leak, with made-up numbers of bytes in use after each life of a shape.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

std::vector<double> lives(size_t count, const std::function<double(size_t)>& used) {
  std::vector<double> all;
  for (size_t i = 0; i < count; ++i) all.push_back(1e6 + used(i));
  return all;
}

// Half of all differences from one life to the next are positive here, or one more than half: a median is misled.
TEST(Leak, WhatComesAndGoesIsNone) {
  for (const size_t count : {8u, 9u, 12u, 31u, 40u})
    for (const size_t phase : {0u, 1u})
      EXPECT_EQ(leakOf(lives(count, [&](size_t i) { return (i + phase) % 2 == 0 ? 0.0 : 1e5; })), 0) << count;
  EXPECT_EQ(leakOf(lives(40, [](size_t i) { return 1e4 * static_cast<double>(i % 7); })), 0);
}

TEST(Leak, WhatIsTakenOnceIsNone) {
  for (size_t when = 0; when < 40; ++when)
    EXPECT_EQ(leakOf(lives(40, [&](size_t i) { return i >= when ? 1e6 : 0.0; })), 0) << when;
}

TEST(Leak, BothTogetherAreNone) {
  for (size_t when = 0; when < 40; ++when)
    EXPECT_EQ(leakOf(lives(40, [&](size_t i) { return (i >= when ? 1e6 : 0.0) + (i % 2 == 0 ? 0.0 : 1e5); })), 0)
        << when;
}

TEST(Leak, WhatGrowsInEachLifeIsTold) {
  for (const size_t count : {8u, 40u})
    EXPECT_NEAR(leakOf(lives(count, [](size_t i) { return 1000.0 * static_cast<double>(i); })), 1000, 1e-6) << count;
}

// The sawtooth is a hundred times as high as the leak is a life.
TEST(Leak, IsSeenThroughWhatComesAndGoes) {
  for (const double period : {2, 3, 5})
    EXPECT_NEAR(leakOf(lives(40,
                             [&](size_t i) {
                               const auto life = static_cast<double>(i);
                               return 1000 * life + 1e5 * std::fmod(life, period);
                             })),
                1000, 500)
        << period;
}

TEST(Leak, FewLivesSayNothing) {
  EXPECT_EQ(leakOf(lives(7, [](size_t i) { return 1000.0 * static_cast<double>(i); })), 0);
}

}  // namespace
}  // namespace hapticd::conformance
