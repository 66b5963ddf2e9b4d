// SPDX-License-Identifier: MIT
/// Crashes as soon as it is loaded.
#include <csignal>

namespace {
struct Crash {
  Crash() { std::raise(SIGSEGV); }
} crash;
}  // namespace
