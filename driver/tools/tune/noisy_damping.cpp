// SPDX-License-Identifier: MIT
#include "tune/noisy_damping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "servo/velocity/estimator_delay.hpp"
#include "servo/velocity/probe_velocity.hpp"

namespace hapticd::tune {
namespace {

constexpr double kKnock = 0.5;            ///< [N] a force of some ticks that a hand feels as a knock
constexpr double kLatestEstimate = 0.01;  ///< [s] no longer delay of an estimate is advised

/// Returns the largest speed [m/s] that the estimator sees when the position grows by one count and stays there.
double speedOfOneCount(servo::VelocityEstimator estimator, double rate, double count) {
  constexpr int kBefore = 100, kAfter = 2000;
  double most = 0;
  for (int i = 0; i < kBefore + kAfter; ++i) {
    const double x = i < kBefore ? 0 : count;
    most = std::max(most, estimator.update(Eigen::Vector3d(x, 0, 0), i == 0 ? 0 : 1 / rate).norm());
  }
  return most;
}

/// Returns what to change, so that a count gives at most kKnock.
std::string adviceOf(const scene::Velocity& how, double rate, double force, double damping) {
  const std::string less = fmt::format("a damping of at most {:.2g} N s/m", kKnock / force * damping);
  const double longer = std::ceil(how.parameter * force / kKnock);
  if (how.estimator != "window" || servo::estimatorDelay({"window", longer}, rate) > kLatestEstimate) return less;
  return fmt::format("{}, or a longer window: servo.velocity.parameter: {:g}", less, longer);
}

}  // namespace

document::Problems noisyDamping(const scene::Scene& scene, const scene::Device& device, const hdv_info& info) {
  document::Problems warnings;
  const double rate = info.rate_hz > 0 ? std::min(info.rate_hz, scene.servo.rate) : scene.servo.rate;
  const auto estimator = servo::makeEstimator(scene.servo.velocity, rate, info.resolution_m);
  if (!estimator || info.resolution_m <= 0) return warnings;
  const double speed = speedOfOneCount(*estimator, rate, info.resolution_m);
  for (size_t i = 0; i < scene.models.size(); ++i)
    for (const std::string_view key : {"damping", "contact_damping", "viscosity"}) {
      const scene::Value* given = givenIn(scene.models[i].parameters, key);
      const bool of_its_swing = key == "damping" && scene.models[i].plugin == "pendulum";  // in N m s/rad
      const double force = given != nullptr && !of_its_swing ? given->number * speed : 0;
      if (force <= kKnock) continue;
      document::report(
          warnings, given->place.line > 0 ? given->place : scene.models[i].place,
          fmt::format("models[{}].parameters.{}", i, key),
          fmt::format("one count of {} ({:.3g} um) looks like {:.2g} m/s at {:g} Hz, so {} N s/m give a knock of "
                      "{:.2g} N; expected {}",
                      device.name, info.resolution_m * 1e6, speed, rate, given->number, force,
                      adviceOf(scene.servo.velocity, rate, force, given->number)));
    }
  return warnings;
}

}  // namespace hapticd::tune
