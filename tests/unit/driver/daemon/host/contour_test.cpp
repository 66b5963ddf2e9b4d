// SPDX-License-Identifier: MIT
#include "host/contour.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace hapticd::host {
namespace {

/// Steps for `seconds` at `rate`; each frame is filled with its number.
int framesOf(Contour& contour, double seconds, double rate, int first = 0) {
  int frames = 0;
  for (int i = 0; i < seconds * rate; ++i) {
    float* xyz = contour.offer(1 / rate);
    if (xyz != nullptr) std::fill_n(xyz, 3 * contour.vertices(), static_cast<float>(first + ++frames));
    contour.close(true);
  }
  return frames;
}

TEST(Contour, NothingIsWrittenWhileNobodyLooks) {
  Contour contour(4);
  EXPECT_EQ(framesOf(contour, 1, 1000), 0);
  EXPECT_EQ(contour.newest().number, 0u);
  EXPECT_GT(framesOf(contour, 1, 1000), 0);
}

TEST(Contour, FramesComeSixtyTimesASecondAtAnyRate) {
  for (const double rate : {500.0, 1000.0, 10'000.0}) {
    Contour contour(4);
    int frames = 0;
    for (int i = 0; i < 10; ++i) {
      contour.newest();
      frames += framesOf(contour, .5, rate);
    }
    EXPECT_NEAR(frames, 300, 3) << rate;
  }
}

TEST(Contour, EndsASecondAfterTheLastLook) {
  Contour contour(4);
  contour.newest();
  EXPECT_NEAR(framesOf(contour, 10, 1000), 60, 1);
}

TEST(Contour, ShowsTheNewestWholeFrame) {
  Contour contour(4);
  contour.newest();
  EXPECT_EQ(framesOf(contour, .1, 1000), 7);  // the first at once
  const Contour::Frame& frame = contour.newest();
  EXPECT_EQ(frame.number, 7u);
  ASSERT_EQ(frame.xyz.size(), 12u);
  EXPECT_EQ(frame.xyz.front(), 7);
  EXPECT_EQ(frame.xyz.back(), 7);
}

TEST(Contour, AStepThatFailedShowsNothing) {
  Contour contour(4);
  contour.newest();
  ASSERT_NE(contour.offer(1), nullptr);
  contour.close(false);
  EXPECT_EQ(contour.newest().number, 0u);
}

TEST(Contour, AReaderNeverSeesAHalfWrittenFrame) {
  Contour contour(500);
  contour.newest();
  std::atomic<bool> done{false};
  std::thread servo([&] {
    for (int written = 0; !done; written += framesOf(contour, 1. / 60, 60, written)) {
    }
  });
  uint64_t last = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Contour::Frame& frame = contour.newest();
    ASSERT_GE(frame.number, last);
    last = frame.number;
    if (last == 0) continue;
    for (const float x : frame.xyz) ASSERT_EQ(x, frame.xyz[0]);
  }
  done = true;
  servo.join();
}

}  // namespace
}  // namespace hapticd::host
