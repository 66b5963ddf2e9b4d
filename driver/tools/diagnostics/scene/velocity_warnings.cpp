// SPDX-License-Identifier: MIT
#include "diagnostics/scene/velocity_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "diagnostics/reading/key_place.hpp"
#include "servo/arm/velocity_use.hpp"
#include "servo/velocity/estimator_delay.hpp"
#include "servo/velocity/probe_velocity.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr const char* kParameter = "servo.velocity.parameter";

document::Place placeInServo(const scene::Scene& scene, const std::string& key) {
  for (const std::string& at : {key, std::string("servo.velocity"), std::string("servo")})
    if (const auto place = placeOfKey(scene.file, at)) return *place;
  return {scene.file.string()};
}

/// Returns true if some arm of the run estimates velocities.
bool isUsed(const scene::Scene& scene, bool needs_velocity) {
  return std::any_of(scene.devices.begin(), scene.devices.end(), [&](const scene::Device& device) {
    return servo::usesVelocity(device, scene.clients, needs_velocity);
  });
}

}  // namespace

document::Problems refusedVelocity(const scene::Scene& scene, bool needs_velocity, document::Problems& idle) {
  document::Problems problems;
  const auto made = servo::makeEstimator(scene.servo.velocity, scene.servo.rate);
  if (made) return problems;
  const std::string before = "servo.velocity: ";
  const std::string what = made.error().rfind(before, 0) == 0 ? made.error().substr(before.size()) : made.error();
  if (isUsed(scene, needs_velocity))
    document::report(problems, placeInServo(scene, kParameter), kParameter, what);
  else
    document::report(idle, placeInServo(scene, kParameter), kParameter,
                     what + "; nothing here uses a velocity yet, so it still runs");
  return problems;
}

document::Problems lateVelocity(const scene::Scene& scene, bool needs_velocity) {
  constexpr double kLate = 0.02;  // [s] a fifth of the period of a hand that moves at 10 Hz, which is fast
  document::Problems warnings;
  const scene::Velocity& how = scene.servo.velocity;
  const double delay = servo::estimatorDelay(how, scene.servo.rate);
  if (!isUsed(scene, needs_velocity) || delay <= kLate) return warnings;
  const bool cut_off = how.estimator == "butterworth";
  const double most = 2 * kLate * scene.servo.rate;
  const double rate = scene.servo.rate;
  const std::string lags = cut_off ? fmt::format("a cut-off of {:.4g} Hz", how.parameter)
                           : how.estimator == "kalman"
                               ? fmt::format("the estimator kalman at {:g} Hz", rate)
                               : fmt::format("{} over {:.4g} samples at {:g} Hz", how.estimator, how.parameter, rate);
  const std::string fix = cut_off ? "expected 50 Hz or more (only the estimator window takes a number of samples)"
                          : how.estimator == "kalman" ? "expected a higher servo.rate"
                                                      : fmt::format("expected at most {:.0f}", std::floor(most));
  document::report(warnings, placeInServo(scene, kParameter), kParameter,
                   fmt::format("{} lags by up to {:.3g} ms: "
                               "damping and friction act too late, and can push the hand; {}",
                               lags, delay * 1e3, fix));
  return warnings;
}

document::Problems wideScales(const scene::Scene& scene) {
  constexpr double kWideScale = 0.05, kWideHysteresis = 1;  // [m]
  document::Problems warnings;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const std::vector<scene::Value>& given = scene.models[i].parameters;
    const scene::Value *scale = givenIn(given, "depth_scale"), *damping = givenIn(given, "damping");
    const scene::Value* exponent = givenIn(given, "exponent");
    if (scale == nullptr || damping == nullptr || scale->number < kWideScale || damping->number <= 0) continue;
    document::report(
        warnings, scale->place, fmt::format("models[{}].parameters.depth_scale", i),
        fmt::format("the scale is {:g} m: {} has its full damping of {:g} N s/m only at this depth; "
                    "at 1 mm it has {:.2g} N s/m; the value must be in m (1 mm is 0.001)",
                    scale->number, scene.models[i].name, damping->number,
                    damping->number * std::pow(1e-3 / scale->number, exponent != nullptr ? exponent->number : 1)));
  }
  if (scene.servo.hysteresis > kWideHysteresis)
    document::report(
        warnings, placeInServo(scene, "servo.hysteresis"), "servo.hysteresis",
        fmt::format(
            "{:g} m is added to the activation radius of {:g} m, so a surface that was traced once is never dropped; "
            "the value must be in m (50 mm is 0.05)",
            scene.servo.hysteresis, scene.servo.activation_radius));
  return warnings;
}

}  // namespace hapticd::diagnostics
