// SPDX-License-Identifier: MIT
/// Settings of the machine rather than of a scene: the daemon file, config/hapticd.yaml.
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

namespace hapticd::scene {

struct Daemon {
  std::filesystem::path file;
  std::vector<std::filesystem::path> plugin_path;  ///< searched before all other folders
  std::optional<int> cpu;                          ///< processor on which the servo thread runs
  std::optional<int> priority;                     ///< SCHED_FIFO
  std::optional<double> force;  ///< [N] no device of this machine pushes harder, whatever its file says
  std::optional<double> rate;   ///< [Hz] used in place of the scene's
};

}  // namespace hapticd::scene
