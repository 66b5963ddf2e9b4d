// SPDX-License-Identifier: MIT
/// Checks that code may run in the servo thread: an RtScope counts every allocation, release and lock of its thread.
/// Link hapticd_rt_guard to use it. It replaces malloc() and its relatives, and pthread_mutex_lock(), in the test
/// program.
#pragma once
#include <cstdint>
#include <ostream>

namespace hapticd::test {

/// What a thread has done inside its RtScope that is forbidden in the servo thread.
struct RtViolations {
  uint64_t allocations = 0, releases = 0, locks = 0;
  bool operator==(const RtViolations&) const = default;
  uint64_t total() const { return allocations + releases + locks; }
};

inline std::ostream& operator<<(std::ostream& out, const RtViolations& v) {
  return out << v.allocations << " allocations, " << v.releases << " releases, " << v.locks << " locks";
}

/// While this object lives, the calls of its thread are counted. A thread may have only one at a time.
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
