// SPDX-License-Identifier: MIT
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>

#include "watch/process_end.hpp"

namespace hapticd::watch {

namespace {
std::atomic<void (*)()> told_first{nullptr};

[[noreturn]] [[maybe_unused]] void plainExit(int code) noexcept {
  if (void (*heard)() = told_first.load()) heard();
  endProcess(code);
}
}  // namespace

void onPlainExit(void (*heard)()) {
  told_first.store(heard);
}

void endProcess(int code) noexcept {
  for (;;) syscall(SYS_exit_group, code);
}

}  // namespace hapticd::watch

#ifndef HAPTICD_SANITIZED
// Replaces the C library's functions for all modules, because the loader searches the program's own symbols first.
// Calls inside the C library, as in exit() and posix_spawn(), still use the library's own functions. The sanitizers
// also replace these functions.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): these names are the C library's
__attribute__((visibility("default"))) void _exit(int code) {
  hapticd::watch::plainExit(code);
}
__attribute__((visibility("default"))) void _Exit(int code) noexcept {
  hapticd::watch::plainExit(code);
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
}
#endif
