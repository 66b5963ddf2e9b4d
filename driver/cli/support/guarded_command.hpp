// SPDX-License-Identifier: MIT
/// Watches a command while it calls plugins. If a plugin crashes, exits or hangs, a message names it and the line of
/// the scene that asks for it.
#pragma once
#include <filesystem>

#include "base/code_owner.hpp"
#include "base/os.hpp"
#include "watch/crash.hpp"
#include "watch/idle_target.hpp"

namespace hapticd::cli {

class GuardedCommand {
 public:
  /// [main] @param dir folder of the quarantine. If a plugin ends this command, it is added to the quarantine there. If
  /// empty, the message only names the plugin
  explicit GuardedCommand(const std::filesystem::path& dir = {}) : guard_(none_, dir) { os::prepareSignalStack(); }

 private:
  WorkerScope working_{Worker::kMain};
  watch::IdleTarget none_;
  watch::CrashGuard guard_;
};

}  // namespace hapticd::cli
