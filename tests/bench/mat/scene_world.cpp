// SPDX-License-Identifier: MIT
#include "scene_world.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <stdexcept>

#include "scene/load.hpp"

namespace hapticd::bench_mat {

using Eigen::Vector3d;

std::unique_ptr<servo::World> buildWorld(const std::string& scene, const std::filesystem::path& folder,
                                         double& seconds) {
  std::ofstream(folder / "scene.yaml") << scene;
  host::Catalog catalog;
  scene::Loaded loaded = scene::load(folder / "scene.yaml", catalog, {.default_device = false, .device_file = {}});
  std::string problems;
  for (const document::Problem& problem : loaded.problems) problems += problem.text() + "\n";
  if (!loaded.scene) throw std::runtime_error(problems);
  const auto begun = std::chrono::steady_clock::now();
  auto world = servo::World::build(*loaded.scene, {1000, 1, false}, [](int, const auto&, const auto&) {});
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  if (!world) throw std::runtime_error(world.error());
  return std::move(*world);
}

double Ticks::at(double quantile) {
  const auto place = static_cast<std::ptrdiff_t>(quantile * static_cast<double>(times.size() - 1));
  std::nth_element(times.begin(), times.begin() + place, times.end());
  return times[static_cast<std::size_t>(place)];
}

Ticks Hand::ticks(int count, const std::function<Vector3d(int)>& path) {
  Ticks result;
  for (int i = 0; i < count; ++i) {
    prepare(path(i));
    const auto begun = std::chrono::steady_clock::now();
    run();
    result.times.push_back(1e6 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
  }
  return result;
}

void Hand::prepare(const Vector3d& at) {
  probe_.velocity = count_ == 0 ? Vector3d(Vector3d::Zero()) : Vector3d((at - probe_.position) * 1e3);
  probe_.position = at;
  world_.core().publish(1e-3 * count_, {&probe_, 1});
  lockstep_.before(1e-3 * count_);
}

void Hand::run() {
  world_.core().tick(1e-3 * count_, count_ == 0 ? 0 : 1e-3, {&probe_, 1});
  ++count_;
}

}  // namespace hapticd::bench_mat
