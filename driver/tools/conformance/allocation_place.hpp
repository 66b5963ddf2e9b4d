// SPDX-License-Identifier: MIT
/// Which function of a plugin allocates, told by the stack of its first allocation.
#pragma once
#include <string>

namespace hapticd::conformance {

/// Surrounds one call of step(); the first allocation within any of these is kept.
class AllocationWatch {
 public:
  AllocationWatch() noexcept;
  ~AllocationWatch();
  AllocationWatch(const AllocationWatch&) = delete;
  AllocationWatch& operator=(const AllocationWatch&) = delete;
};

/// [main] From now on AllocationWatch objects take effect.
void watchAllocations();

/// The function of that file that made the first allocation, and how to find its line: " in NAME (...)". "" if none was
/// seen, or it is unknown.
std::string firstAllocationIn(const std::string& file);

}  // namespace hapticd::conformance
