// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <thread>

#include "base/spsc_ring.hpp"
#include "base/triple_buffer.hpp"

namespace hapticd {
namespace {

TEST(SpscRing, RefusesWhenFullAndKeepsOrder) {
  SpscRing<int> ring(4);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(4));
  for (int i = 0, got = -1; i < 4; ++i) {
    EXPECT_TRUE(ring.pop(got));
    EXPECT_EQ(got, i);
  }
  int none = 0;
  EXPECT_FALSE(ring.pop(none));
}

TEST(SpscRing, ShowsWhatWasAddedOnlyWhenPublished) {
  SpscRing<int> ring(4);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(ring.add(i));
  int got = -1;
  EXPECT_FALSE(ring.pop(got));
  ring.publish();
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(ring.pop(got));
    EXPECT_EQ(got, i);
  }
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.add(i));
  EXPECT_FALSE(ring.add(4)) << "four are not published yet, and there is room for no more";
  EXPECT_FALSE(ring.pop(got));
}

TEST(SpscRing, LosesAndReordersNothingBetweenTwoThreads) {
  constexpr int kCount = 50000;
  SpscRing<int> ring(64);
  std::thread writer([&] {
    for (int i = 0; i < kCount;)
      if (ring.push(i)) {
        ++i;
      } else {
        std::this_thread::yield();  // on a busy machine both threads may share a processor
      }
  });
  for (int expected = 0, got = 0; expected < kCount;)
    if (ring.pop(got)) {
      ASSERT_EQ(got, expected++);
    } else {
      std::this_thread::yield();
    }
  writer.join();
}

TEST(TripleBuffer, ReaderSeesOnlyWholeAndNeverOlderValues) {
  constexpr int kCount = 50000;
  struct Pair {
    int a = 0, b = 0;
  };
  TripleBuffer<Pair> buffer;
  std::thread writer([&] {
    for (int i = 1; i <= kCount; ++i) {
      buffer.back() = {i, -i};
      buffer.publish();
    }
  });
  for (int last = 0; last < kCount;) {
    if (!buffer.update()) {
      std::this_thread::yield();
      continue;
    }
    const Pair pair = buffer.front();
    ASSERT_EQ(pair.a, -pair.b);
    ASSERT_GE(pair.a, last);
    last = pair.a;
  }
  writer.join();
}

}  // namespace
}  // namespace hapticd
