// SPDX-License-Identifier: MIT
#include "tune/noisy_damping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/short_number.hpp"
#include "servo/velocity/estimator_delay.hpp"
#include "servo/velocity/probe_velocity.hpp"
#include "tune/stability.hpp"

namespace hapticd::tune {
namespace {

constexpr double kPress = 4;              ///< [N] of a hand that touches a wall
constexpr double kKnock = 0.5;            ///< [N] a force of some ticks that a hand feels as a knock
constexpr double kLatestEstimate = 0.01;  ///< [s] no longer delay of an estimate is advised

double sampleRate(const scene::Scene& scene, const hdv_info& info) {
  return info.rate_hz > 0 ? std::min(info.rate_hz, scene.servo.rate) : scene.servo.rate;
}

/// Returns how much of a short knock the hand feels: it moves the hand together with the mass of the arm.
double feltShare(const hdv_info& info) {
  constexpr double kHand = 0.2;  // [kg] of a hand that holds the arm
  return kHand / (kHand + std::max(info.mass_kg, 0.0));
}

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

/// Returns by how much the damping of a wall has grown where it pushes as a hand does; 1 if it does not grow. The
/// damping of these walls grows as their force does.
double growthOf(const scene::Model& model, std::string_view key) {
  constexpr double kDeepest = 0.1;      // [m] nobody presses deeper
  constexpr double kDepthScale = 1e-3;  // [m] if the scene gives none
  const bool grows = model.plugin == "nurbs_rigid" ? key == "damping" : key == "contact_damping";
  const double k = numberIn(model.parameters, "stiffness");
  const double depth_scale = numberIn(model.parameters, "depth_scale", kDepthScale);
  if (!grows || !(k > 0) || !(depth_scale > 0)) return 1;
  return std::max(1.0, std::min(kPress / k, kDeepest) / depth_scale);
}

/// Returns whether a model is as stable with a longer window, which is later.
bool bears(scene::Scene scene, const scene::Device& device, const hdv_info& info, size_t model, double window) {
  std::vector<double> stiffness(scene.models.size(), 0);
  stiffness[model] = numberIn(scene.models[model].parameters, "stiffness");
  const std::string key = fmt::format("models[{}].", model);
  const auto unstable = [&] {
    const document::Problems all = unstableSettings(scene, device, info, stiffness);
    return std::count_if(all.begin(), all.end(), [&](const auto& one) { return one.key.starts_with(key); });
  };
  const auto before = unstable();
  scene.servo.velocity.parameter = window;
  return unstable() <= before;
}

/// Returns what to change, so that a count gives at most kKnock.
std::string adviceOf(const scene::Scene& scene, const scene::Device& device, const hdv_info& info, size_t model,
                     double force, double damping) {
  const scene::Velocity& how = scene.servo.velocity;
  const double rate = sampleRate(scene, info);
  const std::string less = fmt::format("a damping of at most {:g} N s/m", roundedDown(kKnock / force * damping));
  const double longer = std::ceil(how.parameter * force / kKnock);
  if (how.estimator != "window" || servo::estimatorDelay({"window", longer}, rate) > kLatestEstimate) return less;
  if (!bears(scene, device, info, model, longer)) return less;
  return fmt::format("{}, or a longer window: servo.velocity.parameter: {:g}", less, longer);
}

}  // namespace

document::Problems noisyDamping(const scene::Scene& scene, const scene::Device& device, const hdv_info& info) {
  document::Problems warnings;
  const double rate = sampleRate(scene, info);
  const auto estimator = servo::makeEstimator(scene.servo.velocity, rate, info.resolution_m);
  if (!estimator || info.resolution_m <= 0) return warnings;
  const double speed = speedOfOneCount(*estimator, rate, info.resolution_m), share = feltShare(info);
  for (size_t i = 0; i < scene.models.size(); ++i)
    for (const std::string_view key : {"damping", "contact_damping", "viscosity"}) {
      const scene::Value* given = givenIn(scene.models[i].parameters, key);
      const bool of_its_swing = key == "damping" && scene.models[i].plugin == "pendulum";  // in N m s/rad
      const double growth = growthOf(scene.models[i], key);
      const double force = given != nullptr && !of_its_swing ? given->number * growth * speed * share : 0;
      if (force <= kKnock) continue;
      const std::string grown = growth > 1 ? fmt::format(", which have grown to {:.3g} where it pushes with {:g} N,",
                                                         given->number * growth, kPress)
                                           : "";
      document::report(
          warnings, given->place.line > 0 ? given->place : scene.models[i].place,
          fmt::format("models[{}].parameters.{}", i, key),
          fmt::format("one count of {} ({:.3g} um) looks like {:.2g} m/s at {:g} Hz, so {} N s/m{} give a knock "
                      "of {:.2g} N; expected {}",
                      device.name, info.resolution_m * 1e6, speed, rate, given->number, grown, force,
                      adviceOf(scene, device, info, i, force, given->number)));
    }
  return warnings;
}

}  // namespace hapticd::tune
