// SPDX-License-Identifier: MIT
/// A scene in the whole servo core, ticked by a probe that is put anywhere.
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

/// Builds the world of a scene text whose files stand in `folder`; `seconds` is the time it took, without reading YAML.
std::unique_ptr<servo::World> buildWorld(const std::string& scene, const std::filesystem::path& folder,
                                         double& seconds);

/// Times of ticks [us].
struct Ticks {
  std::vector<double> times;
  double at(double quantile);  ///< 0 to 1
};

class Hand {
 public:
  explicit Hand(servo::World& world) : world_(world), lockstep_(world.lockstep()) { probe_.valid = true; }

  void tick(const Eigen::Vector3d& at) {
    prepare(at);
    run();
  }
  /// Times of ticks alone, while the probe is where `path(tick)` says.
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
