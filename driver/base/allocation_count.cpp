// SPDX-License-Identifier: MIT
#include "base/allocation_count.hpp"

#include <cerrno>
#include <cstddef>

namespace {
// Plain TLS of the executable: reading it never allocates itself.
__thread uint64_t allocations __attribute__((tls_model("initial-exec"))) = 0;
__thread void (*look)() __attribute__((tls_model("initial-exec"))) = nullptr;

[[maybe_unused]] void countOne() {
  ++allocations;
  if (look == nullptr) return;
  void (*const asked)() = look;
  look = nullptr;
  asked();
  look = asked;
}
}  // namespace

namespace hapticd {
uint64_t allocationsOfThread() noexcept {
  return allocations;
}
void onAllocation(void (*asked)()) noexcept {
  look = asked;
}
}  // namespace hapticd

#if defined(__GLIBC__) && !defined(HAPTICD_SANITIZED)
// The sanitizers bring an allocator of their own, and catch more than these counters do.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): these names are the C library's
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);

__attribute__((visibility("default"))) void* malloc(size_t size) {
  countOne();
  return __libc_malloc(size);
}
__attribute__((visibility("default"))) void* calloc(size_t count, size_t size) {
  countOne();
  return __libc_calloc(count, size);
}
__attribute__((visibility("default"))) void* realloc(void* block, size_t size) {
  countOne();
  return __libc_realloc(block, size);
}
__attribute__((visibility("default"))) void* memalign(size_t alignment, size_t size) {
  countOne();
  return __libc_memalign(alignment, size);
}
__attribute__((visibility("default"))) void* aligned_alloc(size_t alignment, size_t size) {
  countOne();
  return __libc_memalign(alignment, size);
}
__attribute__((visibility("default"))) int posix_memalign(void** block, size_t alignment, size_t size) {
  countOne();
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
}
#endif
