// SPDX-License-Identifier: MIT
#include "base/allocation_owner.hpp"

#include <array>
#include <atomic>

#include "base/allocation_count.hpp"

namespace hapticd {
namespace {

/// Largest number of owners whose allocations are counted. Further owners are not counted, because a message names only
/// one owner.
constexpr size_t kOwners = 16;

struct OwnerCount {
  std::atomic<const Owner*> owner{nullptr};
  std::atomic<uint64_t> count{0};
};

std::array<OwnerCount, kOwners> g_noted;

/// This runs within malloc, so it takes no lock and allocates nothing.
void noteOne() {
  const Owner* const owner = currentOwner();
  if (owner == nullptr) return;
  for (OwnerCount& noted : g_noted) {
    const Owner* known = nullptr;
    if (!noted.owner.compare_exchange_strong(known, owner, std::memory_order_relaxed) && known != owner) continue;
    noted.count.fetch_add(1, std::memory_order_relaxed);
    return;
  }
}

}  // namespace

void noteAllocations(bool on) noexcept {
  onAllocation(on ? &noteOne : nullptr);
}

AllocationShare mostAllocations() noexcept {
  AllocationShare most;
  for (const OwnerCount& noted : g_noted)
    if (const uint64_t count = noted.count.load(std::memory_order_relaxed); count > most.count)
      most = {noted.owner.load(std::memory_order_relaxed), count};
  return most;
}

}  // namespace hapticd
