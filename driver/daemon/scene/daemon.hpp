// SPDX-License-Identifier: MIT
/// Settings of the machine rather than of a scene: the daemon file, config/hapticd.yaml.
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

namespace hapticd::scene {

struct Daemon {
  std::filesystem::path file;
  std::vector<std::filesystem::path> plugin_path;  ///< searched before all other directories
  std::optional<int> cpu;                          ///< processor of the servo thread
  std::optional<int> priority;                     ///< SCHED_FIFO
  std::optional<double> force;  ///< [N] no device of this machine pushes harder, whatever its file says
  std::optional<double> rate;   ///< [Hz] instead of the scene's
};

}  // namespace hapticd::scene
