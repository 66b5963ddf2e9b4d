// SPDX-License-Identifier: MIT
#include "rt_guard.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace hapticd::test {
namespace {

/// Keeps the compiler from removing an allocation that nothing uses.
void use(const void* block) {
  asm volatile("" : : "r"(block) : "memory");
}

TEST(RtScope, SeesNothingInArithmetic) {
  double sum = 0;
  RtViolations seen;
  {
    const RtScope scope;
    for (int i = 0; i < 1000; ++i) sum += i * 0.5;
    seen = scope.violations();
  }
  use(&sum);
  EXPECT_EQ(seen, RtViolations{});
}

TEST(RtScope, CatchesEveryKindOfAllocation) {
  void* moved = std::malloc(8);
  void* placed = nullptr;
  RtViolations seen;
  {
    const RtScope scope;
    void* blocks[] = {std::malloc(8), std::calloc(2, 8), std::aligned_alloc(64, 64), ::operator new(8)};
    moved = std::realloc(moved, 1u << 16);
    const int worked = posix_memalign(&placed, 64, 64);
    use(&worked);
    seen = scope.violations();
    for (void* block : blocks) use(block);
    std::free(blocks[0]);
    std::free(blocks[1]);
    std::free(blocks[2]);
    ::operator delete(blocks[3]);
    EXPECT_GE(scope.violations().releases, 4u);
  }
  std::free(moved);
  std::free(placed);
  EXPECT_EQ(seen.allocations, 6u);
}

TEST(RtScope, CatchesGrowthOfAVectorAndALongString) {
  std::vector<double> numbers;
  RtViolations seen;
  {
    const RtScope scope;
    numbers.push_back(1);
    const std::string text(100, 'x');
    use(text.data());
    seen = scope.violations();
  }
  EXPECT_EQ(seen.allocations, 2u);
}

TEST(RtScope, CatchesAnUncontendedLock) {
  std::mutex mutex;
  RtViolations seen;
  {
    const RtScope scope;
    const std::lock_guard lock(mutex);
    seen = scope.violations();
  }
  EXPECT_EQ(seen.locks, 1u);
}

TEST(RtScope, LeavesOtherThreadsAlone) {
  std::atomic<bool> begin{false}, done{false};
  std::thread other([&] {
    while (!begin) std::this_thread::yield();
    use(std::make_unique<double>(1).get());
    done = true;
  });
  RtViolations seen;
  {
    const RtScope scope;
    begin = true;
    while (!done) std::this_thread::yield();
    seen = scope.violations();
  }
  other.join();
  EXPECT_EQ(seen, RtViolations{});
}

TEST(RtScope, StartsFromZeroEachTime) {
  {
    const RtScope scope;
    use(std::make_unique<double>(1).get());
  }
  const RtScope scope;
  EXPECT_EQ(scope.violations(), RtViolations{});
}

}  // namespace
}  // namespace hapticd::test
