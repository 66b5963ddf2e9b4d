// SPDX-License-Identifier: MIT
#pragma once
#include "base/clock.hpp"
#include "record/recorder.hpp"

namespace hapticd::servo {

/// A clock of virtual time that waits for the recorder. Otherwise a virtual run, which can be hundreds of times faster
/// than a real one, could lose rows because the disk is too slow.
class RecordedClock final : public Clock {
 public:
  explicit RecordedClock(const record::Recorder& recorder) : recorder_(recorder) {}
  Nanoseconds now() noexcept HSP_RT override { return clock_.now(); }
  Nanoseconds waitUntil(Nanoseconds deadline) noexcept HSP_RT override {
    constexpr Nanoseconds kPause = 1'000'000;
    while (recorder_.behind()) pause_.waitUntil(pause_.now() + kPause);
    return clock_.waitUntil(deadline);
  }

 private:
  const record::Recorder& recorder_;
  VirtualClock clock_;
  RealClock pause_{0};
};

}  // namespace hapticd::servo
