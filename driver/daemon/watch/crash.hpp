// SPDX-License-Identifier: MIT
/// The end of a daemon whose plugin crashed, called exit(), or never came back: motors off first, then the black box
/// with the plugin's name, then a note that keeps the plugin out of the next start, then the exit.
#pragma once
#include <filesystem>
#include <string>

#include "watch/watched.hpp"

namespace hapticd::watch {

/// [main] Handles every signal that ends a process, exit(), quick_exit() and _exit(), until `forget`. A harmless signal
/// from another process ends the run in order; SIGTERM and the like do what they did before, unless this process sent
/// them itself.
/// @param dir for the black box and the quarantine file; empty: neither is written
void guardAgainstCrash(Watched& servo, const std::filesystem::path& dir);

/// [main] The signals do what they did before, so the servo may be destroyed.
void forgetCrash();

/// [main] From here to the end of the process, after the last command: if a plugin tore memory, whoever frees it finds
/// that, perhaps the last object of the program.
void guardTheEnd(const std::filesystem::path& dir);

/// Does both while the object lives; such objects may nest. The sanitizers have handlers of their own, and keep them.
class CrashGuard {
 public:
  CrashGuard(Watched& servo, const std::filesystem::path& dir);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  Watched* before_;
  std::filesystem::path dir_before_;
};

/// [any] What the handler does, async-signal-safe, ended with exit code 1. @param reason such as "Segmentation fault"
/// @param culprit whose code did it; nullptr: nobody is blamed
[[noreturn]] void dieOf(const char* reason, const Owner* culprit) noexcept;

/// [any] Ends the process at once, motors off first, because it was told to end and could not: nobody is put in
/// quarantine. @param keeps whose code keeps it; nullptr: unknown
[[noreturn]] void endAnyway(const Owner* keeps) noexcept;

}  // namespace hapticd::watch
