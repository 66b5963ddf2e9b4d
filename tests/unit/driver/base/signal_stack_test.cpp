// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>

#include <thread>

#include "base/os.hpp"

namespace hapticd {
namespace {

const void* signalStack() {
  stack_t now{};
  sigaltstack(nullptr, &now);
  return (now.ss_flags & SS_DISABLE) != 0 ? nullptr : now.ss_sp;
}

const void* at_the_end = nullptr;

/// What a key of the thread destroys comes after what is thread_local, so the stack of prepareSignalStack() is freed.
TEST(SignalStack, IsTheFormerOneWhenAThreadEnds) {
  pthread_key_t key;
  ASSERT_EQ(pthread_key_create(&key, [](void*) { at_the_end = signalStack(); }), 0);
  const void *before = nullptr, *prepared = nullptr;
  std::thread([&] {
    before = signalStack();
    os::prepareSignalStack();
    prepared = signalStack();
    pthread_setspecific(key, &key);
  }).join();
  EXPECT_NE(prepared, nullptr);
  EXPECT_NE(prepared, before);
  EXPECT_EQ(at_the_end, before);
  pthread_key_delete(key);
}

}  // namespace
}  // namespace hapticd
