// SPDX-License-Identifier: MIT
/// Proves that code is fit for the servo thread: inside an RtScope every allocation and lock of this thread is counted.
/// Link hapticd_rt_guard; it replaces malloc and its kind, and pthread_mutex_lock, in the test program.
#pragma once
#include <cstdint>
#include <ostream>

namespace hapticd::test {

/// What a thread did inside its RtScope that it must not do in the servo thread.
struct RtViolations {
  uint64_t allocations = 0, releases = 0, locks = 0;
  bool operator==(const RtViolations&) const = default;
  uint64_t total() const { return allocations + releases + locks; }
};

inline std::ostream& operator<<(std::ostream& out, const RtViolations& v) {
  return out << v.allocations << " allocations, " << v.releases << " releases, " << v.locks << " locks";
}

/// While one lives, this thread counts. One at a time a thread.
///   { const RtScope scope; shape.step(step); EXPECT_EQ(scope.violations(), RtViolations{}); }
class RtScope {
 public:
  RtScope() noexcept;
  ~RtScope();
  RtScope(const RtScope&) = delete;
  RtScope& operator=(const RtScope&) = delete;
  RtViolations violations() const noexcept;
};

}  // namespace hapticd::test
