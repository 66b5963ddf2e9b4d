// SPDX-License-Identifier: MIT
#include "rt_guard.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <cerrno>
#include <cstddef>

namespace {
// With the TLS model initial-exec, reading these variables never allocates, not even the first time in a thread.
__thread bool in_rt __attribute__((tls_model("initial-exec"))) = false;
__thread hapticd::test::RtViolations seen __attribute__((tls_model("initial-exec"))) = {};

void countAllocation() noexcept {
  if (in_rt) ++seen.allocations;
}

using LockFunction = int (*)(pthread_mutex_t*);

/// Returns the C library's own pthread_mutex_lock(). dlsym() may allocate, so it is looked up once, before any test
/// runs.
LockFunction realLock() noexcept {
  static const auto found = reinterpret_cast<LockFunction>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  return found;
}

[[gnu::constructor]] void findRealLock() {
  realLock();
}

}  // namespace

namespace hapticd::test {

RtScope::RtScope() noexcept {
  seen = {};
  in_rt = true;
}

RtScope::~RtScope() {
  in_rt = false;
}

RtViolations RtScope::violations() const noexcept {
  return seen;
}

}  // namespace hapticd::test

extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
void __libc_free(void*);

__attribute__((visibility("default"))) void* malloc(size_t size) {
  countAllocation();
  return __libc_malloc(size);
}
__attribute__((visibility("default"))) void* calloc(size_t count, size_t size) {
  countAllocation();
  return __libc_calloc(count, size);
}
__attribute__((visibility("default"))) void* realloc(void* block, size_t size) {
  countAllocation();
  return __libc_realloc(block, size);
}
__attribute__((visibility("default"))) void* memalign(size_t alignment, size_t size) {
  countAllocation();
  return __libc_memalign(alignment, size);
}
__attribute__((visibility("default"))) void* aligned_alloc(size_t alignment, size_t size) {
  countAllocation();
  return __libc_memalign(alignment, size);
}
__attribute__((visibility("default"))) int posix_memalign(void** block, size_t alignment, size_t size) {
  countAllocation();
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
__attribute__((visibility("default"))) void free(void* block) {
  if (in_rt && block != nullptr) ++seen.releases;
  __libc_free(block);
}
__attribute__((visibility("default"))) int pthread_mutex_lock(pthread_mutex_t* mutex) {
  if (in_rt) ++seen.locks;
  return realLock()(mutex);
}
}
