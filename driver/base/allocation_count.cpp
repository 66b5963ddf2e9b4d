// SPDX-License-Identifier: MIT
#include "base/allocation_count.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

namespace {
// A plain thread-local variable of the executable: reading it never allocates.
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

[[maybe_unused]] constexpr size_t kPlain = alignof(max_align_t);  ///< [bytes] alignment of the blocks of malloc
const hapticd::OtherAllocator* other = nullptr;  ///< never reset, because its blocks may be freed later
__thread bool from_other __attribute__((tls_model("initial-exec"))) = false;

[[maybe_unused]] void* takeOther(size_t size, size_t alignment) {
  return from_other ? other->take(size, alignment) : nullptr;
}
[[maybe_unused]] bool isOther(const void* block) {
  return other != nullptr && block >= other->begin && block < other->end;
}
}  // namespace

namespace hapticd {
uint64_t allocationsOfThread() noexcept {
  return allocations;
}
void onAllocation(void (*asked)()) noexcept {
  look = asked;
}
bool allocateFrom([[maybe_unused]] const OtherAllocator* from) noexcept {
#if defined(__GLIBC__) && !defined(HAPTICD_SANITIZED)
  if (from != nullptr) other = from;
  from_other = from != nullptr;
  return true;
#else
  return false;
#endif
}
}  // namespace hapticd

#if defined(__GLIBC__) && !defined(HAPTICD_SANITIZED)
// The sanitizers replace malloc themselves, and find more errors than these counters do.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): these names are the C library's
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
void __libc_free(void*);

__attribute__((visibility("default"))) void* malloc(size_t size) {
  countOne();
  void* block = takeOther(size, kPlain);
  return block != nullptr ? block : __libc_malloc(size);
}
__attribute__((visibility("default"))) void* calloc(size_t count, size_t size) {
  countOne();
  size_t all = 0;
  void* block = __builtin_mul_overflow(count, size, &all) ? nullptr : takeOther(all, kPlain);
  return block != nullptr ? std::memset(block, 0, all) : __libc_calloc(count, size);
}
__attribute__((visibility("default"))) void free(void* block) {
  if (isOther(block)) return other->give_back(block);
  __libc_free(block);
}
__attribute__((visibility("default"))) void* realloc(void* block, size_t size) {
  countOne();
  if (!isOther(block)) return __libc_realloc(block, size);
  void* larger = takeOther(size, kPlain);
  if (larger == nullptr) larger = __libc_malloc(size);
  if (larger == nullptr) return nullptr;
  std::memcpy(larger, block, std::min(size, other->size(block)));
  other->give_back(block);
  return larger;
}
__attribute__((visibility("default"))) void* memalign(size_t alignment, size_t size) {
  countOne();
  void* block = takeOther(size, alignment);
  return block != nullptr ? block : __libc_memalign(alignment, size);
}
__attribute__((visibility("default"))) void* aligned_alloc(size_t alignment, size_t size) {
  countOne();
  void* block = takeOther(size, alignment);
  return block != nullptr ? block : __libc_memalign(alignment, size);
}
__attribute__((visibility("default"))) int posix_memalign(void** block, size_t alignment, size_t size) {
  countOne();
  *block = takeOther(size, alignment);
  if (*block == nullptr) *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
}
#endif
