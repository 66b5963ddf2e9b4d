// SPDX-License-Identifier: MIT
/// Settings that belong to the machine, not to a scene: the daemon file, config/hapticd.yaml.
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

namespace hapticd::scene {

struct Daemon {
  std::filesystem::path file;
  std::vector<std::filesystem::path> plugin_path;  ///< searched before all other folders
  std::optional<int> cpu;                          ///< processor on which the servo thread runs
  std::optional<int> priority;                     ///< SCHED_FIFO priority of the servo thread
  std::optional<double> force;  ///< [N] largest force of every device, even if its device file allows more
  std::optional<double> rate;   ///< [Hz] servo rate, instead of the scene's
};

}  // namespace hapticd::scene
