// SPDX-License-Identifier: MIT
/// Runs a scene in the whole servo core with a probe that can be placed anywhere.
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "servo/loop/lockstep.hpp"
#include "world/world.hpp"

namespace hapticd::bench_mat {

/// Builds the world of a scene text. @param folder folder of the files that the scene names @param seconds becomes the
/// time it took, without the reading of YAML
std::unique_ptr<servo::World> buildWorld(const std::string& scene, const std::filesystem::path& folder,
                                         double& seconds);

/// Times of ticks [us].
struct Ticks {
  std::vector<double> times;
  double at(double quantile);  ///< quantile from 0 to 1
};

class Hand {
 public:
  explicit Hand(servo::World& world) : world_(world), lockstep_(world.lockstep()) { probe_.valid = true; }

  void tick(const Eigen::Vector3d& at) {
    prepare(at);
    run();
  }
  /// Returns the times of `count` ticks while the probe moves along `path(tick)`. The time of its preparation is not
  /// included.
  Ticks ticks(int count, const std::function<Eigen::Vector3d(int)>& path);

 private:
  void prepare(const Eigen::Vector3d& at);
  void run();

  servo::World& world_;
  servo::Lockstep lockstep_;
  servo::Probe probe_;
  int count_ = 0;
};

}  // namespace hapticd::bench_mat
