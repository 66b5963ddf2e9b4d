// SPDX-License-Identifier: MIT
/// Ends a daemon whose plugin crashed, called exit(), or never returned. It switches the motors off first. Then it
/// notes the plugin, so that the next start leaves it out, saves the black box under the plugin's name, and exits.
#pragma once
#include <filesystem>

#include "watch/watch_target.hpp"

namespace hapticd::watch {

/// [main] Handles every signal that ends a process, exit(), quick_exit() and _exit(), until forgetCrash(). If another
/// process sends a signal that is not a crash, such as SIGUSR1, the run ends normally. SIGTERM, SIGINT, SIGQUIT and
/// SIGHUP keep their former effect, unless this process sent them itself.
/// @param dir folder for the black box and the quarantine file; if it is empty, neither is written
void guardAgainstCrash(WatchTarget& servo, const std::filesystem::path& dir);

/// [main] Ends the watching of the servo, so that it may be destroyed.
void forgetCrash();

/// [main] Called after the last command: handles crashes until the end of the process. If a plugin overwrote memory,
/// the crash may come only when the last objects of the program are destroyed.
void guardTheEnd(const std::filesystem::path& dir);

/// Calls guardAgainstCrash(), and forgetCrash() at the end of its life. Such objects may nest. In builds with
/// sanitizers it does nothing, because the sanitizers have their own handlers.
class CrashGuard {
 public:
  CrashGuard(WatchTarget& servo, const std::filesystem::path& dir);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  WatchTarget* before_;
  std::filesystem::path dir_before_;
};

/// [any] Does what the signal handler does, and ends the process with exit code 1. Async-signal-safe.
/// @param reason such as "Segmentation fault" @param culprit owner of the code that did it; nullptr blames nobody
[[noreturn]] void endByFault(const char* reason, const Owner* culprit) noexcept;

/// [any] Switches the motors off and ends the process at once. It is called if the process was asked to end and did not
/// end. No plugin is put in quarantine. @param keeps owner of the code that did not return; nullptr if it is unknown
[[noreturn]] void forceEnd(const Owner* keeps) noexcept;

}  // namespace hapticd::watch
