// SPDX-License-Identifier: MIT
/// Tells RTSan (the real-time sanitizer of Clang) that the servo thread need not keep real time while the object lives,
/// such as during the search in virtual time.
#pragma once

#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
#include <sanitizer/rtsan_interface.h>
#define HAPTICD_RTSAN 1
#endif
#endif

namespace hapticd {

class NotRealTime {
 public:
#ifdef HAPTICD_RTSAN
  NotRealTime() noexcept { __rtsan_disable(); }
  ~NotRealTime() noexcept { __rtsan_enable(); }
#else
  NotRealTime() noexcept = default;
  ~NotRealTime() noexcept {}
#endif
  NotRealTime(const NotRealTime&) = delete;
  NotRealTime& operator=(const NotRealTime&) = delete;
};

}  // namespace hapticd
