// SPDX-License-Identifier: MIT
/// While a command calls plugins: one that crashes, exits or hangs is named, with the place that asks for it.
#pragma once
#include <filesystem>

#include "base/blame.hpp"
#include "base/os.hpp"
#include "watch/crash.hpp"
#include "watch/ended.hpp"

namespace hapticd::cli {

class GuardedCommand {
 public:
  /// [main] @param dir for the quarantine; if it is empty, the plugin that ends this command is only named
  explicit GuardedCommand(const std::filesystem::path& dir = {}) : guard_(none_, dir) { os::prepareSignalStack(); }

 private:
  Working working_{Worker::kMain};
  watch::Ended none_;
  watch::CrashGuard guard_;
};

}  // namespace hapticd::cli
