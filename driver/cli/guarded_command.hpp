// SPDX-License-Identifier: MIT
/// Watches a command while it calls plugins: if one crashes, exits or hangs, a message names it and the place of the
/// scene that asks for it.
#pragma once
#include <filesystem>

#include "base/code_owner.hpp"
#include "base/os.hpp"
#include "watch/crash.hpp"
#include "watch/idle_target.hpp"

namespace hapticd::cli {

class GuardedCommand {
 public:
  /// [main] @param dir folder of the quarantine, to which a plugin is added that ends this command; if empty, the
  /// plugin is only named
  explicit GuardedCommand(const std::filesystem::path& dir = {}) : guard_(none_, dir) { os::prepareSignalStack(); }

 private:
  WorkerScope working_{Worker::kMain};
  watch::IdleTarget none_;
  watch::CrashGuard guard_;
};

}  // namespace hapticd::cli
