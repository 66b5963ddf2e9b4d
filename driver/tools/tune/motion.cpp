// SPDX-License-Identifier: MIT
#include "tune/motion.hpp"

#include <algorithm>

#include "session/run/runner.hpp"

namespace hapticd::tune {
namespace {

/// Returns the slope of the least-squares line through the samples around each sample.
std::vector<Eigen::Vector3d> slopes(const std::vector<Eigen::Vector3d>& position, double period) {
  constexpr long kHalf = 4;
  const long count = static_cast<long>(position.size());
  std::vector<Eigen::Vector3d> result;
  for (long i = 0; i < count; ++i) {
    const long half = std::min({kHalf, i, count - 1 - i});
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weight = 0;
    for (long k = -half; k <= half; ++k) {
      sum += static_cast<double>(k) * position[static_cast<size_t>(i + k)];
      weight += static_cast<double>(k * k);
    }
    result.push_back(weight > 0 ? Eigen::Vector3d(sum / (weight * period)) : Eigen::Vector3d::Zero());
  }
  return result;
}

}  // namespace

Motion motionThrough(std::vector<Eigen::Vector3d> position, double period) {
  Motion motion;
  motion.period = period;
  motion.velocity = slopes(position, period);
  motion.position = std::move(position);
  return motion;
}

Result<Motion> motionOfHand(const scene::Scene& scene, double seconds, const host::Services::Log& log) {
  servo::RunOptions how;
  how.rate = scene.servo.rate;
  how.duration = std::min(seconds, servo::Telemetry::kBlackBoxSeconds);
  how.virtual_time = true;
  auto world = servo::Runner::buildWorld(scene, how, log);
  if (!world) return Error{world.error()};
  auto runner = servo::Runner::prepare(scene, how, std::move(*world), log);
  if (!runner) return Error{runner.error()};
  if (auto done = (*runner)->run([](const servo::Runner&) {}); !done) return Error{done.error()};
  std::vector<Eigen::Vector3d> position;
  for (const servo::BlackBoxRow& row : (*runner)->telemetry().blackBox())
    position.emplace_back(row.position[0], row.position[1], row.position[2]);
  return motionThrough(std::move(position), 1 / how.rate);
}

Motion resampled(const Motion& motion, double rate) {
  const double period = 1 / rate, last = static_cast<double>(motion.position.size() - 1);
  std::vector<Eigen::Vector3d> position;
  for (long i = 0;; ++i) {
    const double at = static_cast<double>(i) * period / motion.period;
    if (at > last) break;
    const size_t k = std::min(static_cast<size_t>(at), motion.position.size() - 2);
    const double s = at - static_cast<double>(k), h = motion.period;
    const double a = (1 + 2 * s) * (1 - s) * (1 - s), b = s * (1 - s) * (1 - s) * h;  // Hermite basis
    const double c = s * s * (3 - 2 * s), d = s * s * (s - 1) * h;
    position.push_back(a * motion.position[k] + b * motion.velocity[k] + c * motion.position[k + 1] +
                       d * motion.velocity[k + 1]);
  }
  return motionThrough(std::move(position), period);
}

}  // namespace hapticd::tune
