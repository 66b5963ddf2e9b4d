// SPDX-License-Identifier: MIT
/// Judges parameters of any plugin by their units, because the usual range of a quantity follows from its unit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "diagnostics/reading/given_values.hpp"
#include "diagnostics/scene/given_model.hpp"
#include "diagnostics/scene/value_plausibility.hpp"
#include "host/catalog.hpp"
#include "host/device_instance.hpp"
#include "kernels/dynamics/plausible_mass.hpp"
#include "servo/core/minimum_jerk.hpp"
#include "servo/velocity/estimator_delay.hpp"

namespace hapticd::diagnostics {
namespace {

using Eigen::Vector3d;

constexpr double kMilli = 1e-3;
constexpr double kOutOfReach = 5;  ///< [m] farther than anybody reaches

/// Returns the unit of a column, such as "m" for column 0 of "m, N".
std::string unitOf(const host::ParamInfo& param, size_t column) {
  std::string unit = param.unit;
  if (param.columns < 2 || unit.find(',') == std::string::npos) return unit;
  for (; column > 0 && unit.find(", ") != std::string::npos; --column) unit.erase(0, unit.find(", ") + 2);
  return unit.substr(0, unit.find(','));
}

double lengthOf(const scene::Value& value) {
  double sum = value.number * value.number;
  for (const double x : value.numbers) sum += x * x;
  return std::sqrt(sum);
}

/// Returns the largest magnitude of a value in the columns with this unit, or the magnitude of a single number.
double mostIn(const scene::Value& value, const host::ParamInfo& param, const char* unit) {
  if (value.numbers.empty()) return param.unit == unit ? std::abs(value.number) : 0;
  double most = 0;
  for (size_t i = 0; i < value.numbers.size(); ++i)
    if (unitOf(param, i % std::max(param.columns, 1u)) == unit) most = std::max(most, std::abs(value.numbers[i]));
  return most;
}

void checkAngle(const GivenModel& given, const scene::Value& value, const host::ParamInfo& param) {
  constexpr double kHair = 1e-3;
  const double most = mostIn(value, param, "rad");
  if (most > M_PI + kHair)
    given.warn(
        {value.id},
        fmt::format(
            "{0:g} rad is more than half a turn; the value must be in rad: if you meant {0:g} degrees, write {1:.4g}",
            most, most * M_PI / 180));
}

/// Warns of a place that is far away from the model.
void checkPlace(const GivenModel& given, const scene::Value& value) {
  constexpr double kNear = 2, kSizes = 10;  // [m]; [sizes] a pendulum with a small bob is long
  const Vector3d place(value.numbers.data());
  const double away = given.box() ? given.box()->exteriorDistance(place) : place.norm();
  if (away <= std::max(given.box() ? kNear : kOutOfReach, kSizes * given.size())) return;
  const std::string seen_from = given.box() ? fmt::format("the surfaces, which are {:.3g} m large", given.size())
                                            : std::string("the model's origin");
  const double most = place.cwiseAbs().maxCoeff();
  given.warn({value.id}, fmt::format("lies {:.4g} m from {}; the value must be in m: {:g} mm is {:g} m", away,
                                     seen_from, most, most * kMilli));
}

/// Returns true if a list of [travel, force] has its columns swapped: the second one, and not the first, can be
/// travels.
bool hasSwappedColumns(const scene::Value& value, const host::ParamInfo& param) {
  constexpr double kHand = 0.1;  // [m] longer than a button moves
  if (param.columns != 2 || param.unit != "m, N" || value.numbers.size() < 4) return false;
  const auto& all = value.numbers;
  double first = 0;
  for (size_t i = 0; i + 1 < all.size(); i += 2) {
    if (i > 0 && !(all[i + 1] > all[i - 1])) return false;
    first = std::max(first, all[i]);
  }
  return first > kHand && all.back() < kHand;
}

/// Warns of swapped columns. If the first one does not grow, the plugin refuses them.
void checkColumns(const GivenModel& given, const scene::Value& value) {
  for (size_t i = 2; i < value.numbers.size(); i += 2)
    if (!(value.numbers[i] > value.numbers[i - 2])) return;
  given.warn({value.id}, "the columns seem to be swapped; expected [travel in m, force in N] in each row");
}

/// Warns of a contact hysteresis below the noise of an arm and a hand. A metre is allowed: it means that the contact
/// never changes its face.
void checkHysteresis(const GivenModel& given, const scene::Value& value) {
  constexpr double kNoise = 1e-4;  // [m]
  if (!(value.number < kNoise)) return;
  given.warn({value.id},
             fmt::format("with {:g} m a hand that rests near an edge, or in the middle of a wall, feels the "
                         "force turn from face to face with the noise of the arm; leave this out, or "
                         "expected {:g} m or more",
                         value.number, kNoise));
}

void checkLength(const GivenModel& given, const scene::Value& value, const host::ParamInfo& param) {
  for (const char* id : {"contact_hysteresis", "hold"})
    if (value.id == id) return checkHysteresis(given, value);
  const double most = mostIn(value, param, "m");
  // for plugins that ship, lengths are known to be those of the model
  const bool own = host::ships(given.model().library);
  // a wave that is longer than a side makes less than one bump
  const bool wave = value.id == "texture.wavelength";
  const double size = given.box() && wave ? given.box()->sizes().maxCoeff() : given.size();
  // a pendulum may be longer than its bob
  const double bound = given.box() && value.id != "length" ? (wave ? 1 : own ? 2 : 10) * size : kOutOfReach;
  if (most <= bound) return;
  const std::string than = given.box() && value.id != "length" ? fmt::format("the model, which is {:.3g} m large", size)
                                                               : std::string("anybody reaches");
  given.warn({value.id}, fmt::format("{0:g} m is more than {1}; the value must be in m: {0:g} mm is {2:g} m", most,
                                     than, most * kMilli));
}

/// Warns of a speed above the limit for kinematic models. A body that yields may not be faster either, because it would
/// hit the hand or be out of reach at once.
void checkSpeed(const GivenModel& given, const scene::Value& value) {
  if (const double speed = lengthOf(value); speed > servo::MinimumJerk::kMostSpeed)
    given.warn({value.id}, fmt::format("{0:g} m/s is faster than a model may move toward a hand ({1:g} m/s, the limit "
                                       "of ctl move); the value must be in m/s: {0:g} mm/s is {2:g} m/s",
                                       speed, servo::MinimumJerk::kMostSpeed, speed * kMilli));
}

void checkTurn(const GivenModel& given, const scene::Value& value) {
  constexpr double kFast = 5, kFastest = 100;  // [m/s] of the surface; [rad/s]
  const double turn = lengthOf(value), speed = turn * given.size() / 2;
  if (turn > kFastest || speed > kFast)
    given.warn(
        {value.id},
        fmt::format(
            "{0:g} rad/s is {1:.3g} turns per second; the value must be in rad/s: {0:g} degrees/s is {2:.4g} rad/s",
            turn, turn / (2 * M_PI), turn * M_PI / 180));
}

void checkForce(const GivenModel& given, const scene::Value& value, const host::ParamInfo& param) {
  // [N] less than the friction of most arms; more than any arm for a hand gives
  constexpr double kUnfelt = 0.05, kMost = 100;
  const double most = mostIn(value, param, "N");
  if (most > 0 && most < kUnfelt)
    given.warn(
        {value.id},
        fmt::format(
            "{:g} N cannot be felt, because most arms have more friction; the value must be in N (1 mN is 0.001 N)",
            most));
  if (most > kMost)
    given.warn(
        {value.id},
        fmt::format(
            "{0:g} N is more than an arm gives or a hand presses with; the value must be in N: {0:g} mN is {1:g} N",
            most, most * kMilli));
}

/// Warns of an end stop that is softer than the surface that presses on it.
void checkStop(const GivenModel& given, const scene::Value& value) {
  constexpr double kSoft = 100, kSofter = 0.5;  // [N/m], of the surface
  if (value.id != "end_stiffness") return;
  const double surface = given.number("stiffness");
  if (value.number < std::max(kSoft, kSofter * surface))
    given.warn({"end_stiffness"},
               fmt::format("{0:g} N/m is too soft for a stop: 1 mm beyond the travel gives only {1:g} N more, and the "
                           "surface has {2:g} N/m; expected more than the surface, in N/m ({0:g} N/mm is {3:g} N/m)",
                           value.number, value.number * kMilli, surface, value.number * 1000));
}

/// Warns of a further stiffness (other than the surface's) that is too small to feel, because it was given in N/mm as
/// in data sheets.
void checkSpring(const GivenModel& given, const scene::Value& value) {
  constexpr double kUnfelt = 5;                          // [N/m] 10 mm give 0.05 N, less than the friction of most arms
  if (given.plugin().unitOf(value.id) != "N/m") return;  // such as a spring of turns, in N m/rad
  if (value.id != "stiffness" && value.id.ends_with("stiffness") && value.number < kUnfelt)
    given.warn({value.id},
               fmt::format("{:g} N/m cannot be felt: 1 mm gives {:g} N; the value must be in N/m (1 N/mm is 1000 N/m)",
                           value.number, value.number * kMilli));
  checkStop(given, value);
}

/// Returns the least felt mass in kg of the scene's arms; 0 if one is unknown.
double leastMass(const scene::Scene& scene) {
  double least = scene.devices.empty() ? 0 : HUGE_VAL;
  for (const scene::Device& device : scene.devices) {
    const scene::Value* given = givenIn(device.parameters, "device.mass");
    double mass = given != nullptr ? given->number : 0;
    auto arm = device.module == "simulated" ? host::DeviceInstance::create(device, nullptr)
                                            : Result<std::unique_ptr<host::DeviceInstance>>(Error{"not simulated"});
    if (arm && (*arm)->open()) mass = (*arm)->info().mass_kg;
    least = std::min(least, mass);
  }
  return least;
}

/// Returns the strongest damper in N s/m that arms of this felt mass keep stable. Its force comes late: by the delay of
/// the estimated velocity and one and a half ticks.
double mostDamping(const scene::Scene& scene) {
  constexpr double kLightArms = 50, kTicks = 1.5;
  const double late = servo::estimatorDelay(scene.servo.velocity, scene.servo.rate) + kTicks / scene.servo.rate;
  return std::max(kLightArms, leastMass(scene) / late);
}

/// Warns of dampers of the surface that hold back a slow hand with a large force.
void checkDamper(const GivenModel& given, const scene::Value& value) {
  constexpr double kUsual = 50, kCalm = 0.1;  // [N s/m], [m/s]
  if (value.number <= kUsual || (value.id != "damping" && value.id != "viscosity")) return;
  if (given.choice("motion") == "dynamic") return;
  if (const double most = mostDamping(given.scene()); value.number > most)
    given.warn({value.id},
               fmt::format("{0:g} N s/m hold back a hand that moves at {1:g} m/s with {2:.3g} N, which most arms "
                           "cannot render stably; expected at most {3:.3g} N s/m (1 N s/mm is 1000 N s/m)",
                           value.number, kCalm, value.number * kCalm, most));
}

/// Warns of a mass that is both denser than any metal and more than a hand moves with ease.
void checkMass(const GivenModel& given, const scene::Value& value) {
  constexpr double kThin = 0.02;  // share of the size
  if (!given.box() || value.number <= dynamics::kEasyMass) return;
  const bool in_mm = given.size() > kOutOfReach;  // lengths in mm have a warning of their own
  const Vector3d sides = given.box()->sizes().cwiseMax(kThin * given.size()) * (in_mm ? kMilli : 1);
  const double density = value.number / sides.prod();
  if (density > dynamics::kDensest)
    given.warn({value.id},
               fmt::format("{0:g} kg in a box of {1:.3g} x {2:.3g} x {3:.3g} m{6} is {4:.3g} times as dense as lead; "
                           "the value must be in kg: {0:g} g is {5:g} kg",
                           value.number, sides.x(), sides.y(), sides.z(), density / 11'340, value.number * kMilli,
                           in_mm ? " (if its lengths are in mm)" : ""));
}

void checkFriction(const GivenModel& given, const scene::Value& value) {
  constexpr double kRoughest = 2;
  if (value.number > kRoughest)
    given.warn({value.id}, fmt::format("{:g} is more than any material has (friction over pressing force; rubber has "
                                       "about 1), so the tip would stick; expected 0 to {:g}",
                                       value.number, kRoughest));
}

void checkQuantity(const GivenModel& given, const scene::Value& value, const host::ParamInfo& param) {
  const bool real = value.kind == HSP_REAL, list = value.kind == HSP_ARRAY;
  if (!real && !list) return;
  if (hasSwappedColumns(value, param)) return checkColumns(given, value);
  checkAngle(given, value, param);
  if (param.unit == "m" && param.columns == 3 && value.numbers.size() == 3)
    checkPlace(given, value);
  else
    checkLength(given, value, param);
  if (param.unit == "m/s") checkSpeed(given, value);
  if (param.unit == "rad/s") checkTurn(given, value);
  checkForce(given, value, param);
  if (param.unit == "N/m" && real) checkSpring(given, value);
  if (param.unit == "N s/m" && real) checkDamper(given, value);
  if (param.unit == "kg" && real) checkMass(given, value);
  if (param.unit.empty() && real && param.id.find("friction") != std::string::npos) checkFriction(given, value);
}

}  // namespace

void checkQuantities(const GivenModel& given) {
  for (const scene::Value& value : given.model().parameters) {
    given.begin();
    if (value.index < given.plugin().params.size() && given.find(value.id) == &value)
      checkQuantity(given, value, given.plugin().params[value.index]);
  }
  given.begin();
  const scene::Value* sticks = given.find("friction_static");
  if (sticks != nullptr && sticks->number > 0 && given.plugin().indexOf("friction_dynamic") >= 0 &&
      given.find("friction_dynamic") == nullptr && given.number("friction_dynamic") == 0)
    given.warn({"friction_static"},
               "friction_dynamic is not given, so it is 0: once the tip slides, there is no friction; give both");
}

}  // namespace hapticd::diagnostics
