// SPDX-License-Identifier: MIT
/// Watches a command while it calls plugins. If a plugin crashes, exits or hangs, a message names it and the line of
/// the scene that asks for it.
#pragma once
#include <filesystem>
#include <utility>

#include "base/code_owner.hpp"
#include "base/os.hpp"
#include "cli/support/command.hpp"
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

/// [main] Makes `work`, a function that returns an exit code, what a command does. A crash after it is watched until
/// the process ends, because a destructor of a plugin may crash.
template <class Work>
void setGuardedCallback(const Command& command, int& exit_code, Work work) {
  command.callback([&exit_code, work = std::move(work)] {
    exit_code = work();
    watch::guardTheEnd({});
  });
}

}  // namespace hapticd::cli
