// SPDX-License-Identifier: MIT
#include "tune/stability.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/short_number.hpp"
#include "scene/path_rows.hpp"
#include "servo/core/minimum_jerk.hpp"
#include "servo/safety/passivity/isolated.hpp"

namespace hapticd::tune {
namespace {

constexpr double kUnfelt = 5;  ///< [N/m] at a depth of 10 mm this gives less force than the friction of most arms
constexpr double kBuzz = 0.1;  ///< [N] a force step between neighbouring counts that a hand feels

std::string text(double value) {
  return withDigits(value, 4);
}

int windowOf(const scene::Velocity& velocity) {
  return velocity.estimator == "window" ? static_cast<int>(velocity.parameter) : 1;
}

/// Returns the advice to take a shorter window, if one bears the stiffness: a long window is late, as the hand feels
/// it.
std::string shorterWindow(const scene::Servo& servo, double mass, double stiffness) {
  const int now = windowOf(servo.velocity);
  constexpr int kLongest = 100;  // samples; longer ones are of no use at any rate
  for (int n = std::min(now - 1, kLongest); n >= 1; --n)
    if (passivity::maxStiffnessAlone(mass, n, 1 / servo.rate) >= stiffness)
      return ", or servo.velocity.parameter: " + std::to_string(n) + " (a window of " + std::to_string(now) +
             " samples gives the velocity too late)";
  return "";
}

void checkModel(const scene::Scene& scene, size_t index, const scene::Device& device, const hdv_info& info,
                double alone, double stiffness, document::Problems& problems) {
  const scene::Model& model = scene.models[index];
  const std::string key = "models[" + std::to_string(index) + "]";
  const scene::Value* given = givenIn(model.parameters, "stiffness");
  // A value without a place is the plugin's default, or comes from a geometry file.
  const bool named = given != nullptr && given->place.line > 0;
  const auto warn = [&](const std::string& what) {
    document::report(problems, named ? given->place : model.place, named ? key + ".parameters.stiffness" : key, what);
  };
  const std::string claim = model.name + " pushes with up to " + text(stiffness) + " N/m";
  if (info.max_stiffness > 0 && stiffness > info.max_stiffness)
    warn(claim + ", and " + device.name + " is stable up to " + text(info.max_stiffness) + " N/m" +
         (info.max_stiffness < kUnfelt
              ? ", as its device.max_stiffness says; so little cannot be felt, so give device.max_stiffness in N/m (1 "
                "N/mm is 1000 N/m)"
              : "; expected at most " + text(roundedDown(info.max_stiffness)) + " N/m"));
  if (alone > 0 && stiffness > alone)
    warn(claim + ", and at " + text(scene.servo.rate) + " Hz a felt mass of " + text(info.mass_kg) +
         " kg is stable up to " + text(alone) + " N/m without damping of the arm; expected at most " +
         text(roundedDown(alone)) + " N/m, or a rate of " +
         text(std::ceil(scene.servo.rate * std::sqrt(stiffness / alone) / 100) * 100) + " Hz" +
         shorterWindow(scene.servo, info.mass_kg, stiffness));
  if (info.resolution_m > 0 && stiffness * info.resolution_m > kBuzz)
    warn(claim + ", so one count of " + text(info.resolution_m * 1e6) + " um is a step of " +
         text(stiffness * info.resolution_m) + " N, which a hand feels as buzz; expected at most " +
         text(roundedDown(kBuzz / info.resolution_m)) + " N/m");
}

/// Warns of a damping that is not stable where the wall pushes with the whole force of the arm, even in a hand. The
/// damping of a wall grows as its force does: lambda F / (k x0).
void checkDamping(const scene::Scene& scene, size_t index, const scene::Device& device, const hdv_info& info,
                  document::Problems& problems) {
  constexpr double kHand = 0.2;         // [kg] of a hand that holds the arm
  constexpr double kJudged = 50;        // [N s/m] check judges a stronger damper by itself, at any depth
  constexpr double kDepthScale = 1e-3;  // [m] if the scene gives none
  constexpr double kDeepest = 0.1;      // [m] nobody presses deeper; a softer wall is told as such
  const scene::Model& model = scene.models[index];
  const scene::Value* damping = givenIn(model.parameters, "damping");
  const double k = numberIn(model.parameters, "stiffness");
  const double most = device.limits.force > 0 ? device.limits.force : info.max_force;
  if (model.plugin != "nurbs_rigid" || damping == nullptr || !(k > 0) || !(info.mass_kg > 0) || device.admittance)
    return;
  if (!(most <= k * kDeepest)) return;
  const double at_scale = k * numberIn(model.parameters, "depth_scale", kDepthScale);
  const double there = damping->number * most / at_scale;
  const double bound =
      passivity::maxDampingAlone(info.mass_kg + kHand, windowOf(scene.servo.velocity), 1 / scene.servo.rate);
  if (there <= bound || damping->number > kJudged) return;
  document::report(problems, damping->place, "models[" + std::to_string(index) + "].parameters.damping",
                   model.name + " damps with " + text(there) + " N s/m where it pushes with the " + text(most) +
                       " N of " + device.name + ", because its damping grows with depth, and at " +
                       text(scene.servo.rate) + " Hz an arm of " + text(info.mass_kg) + " kg in a hand of " +
                       text(kHand) + " kg is stable up to " + text(bound) + " N s/m; expected at most " +
                       text(roundedDown(damping->number * bound / there)) + " N s/m");
}

/// Warns of a force that the arm cannot sustain. Simulated arms are left out, because their motors cannot burn.
void checkHeat(const scene::Device& device, const hdv_info& info, document::Problems& problems) {
  const double most = device.limits.force > 0 ? device.limits.force : info.max_force;
  const bool guarded = !device.limits.motors.empty() || (info.capabilities & HDV_C_SIMULATED) != 0;
  if (guarded || info.continuous_force <= 0 || most <= info.continuous_force) return;
  document::report(problems, device.place, "limits.force",
                   "the limit is " + text(most) + " N, and " + device.name + " sustains " +
                       text(info.continuous_force) +
                       " N continuously, and nothing protects its motors from heat; expected limits.motors, or a "
                       "limit of at most " +
                       text(info.continuous_force) + " N");
}

/// Compares the rate of the servo with that of the samples, and checks which of them drives the loop.
void checkLoopRate(const scene::Scene& scene, const scene::Device& device, const hdv_info& info,
                   document::Problems& problems) {
  constexpr double kSlack = 1.001;
  const std::string file = scene.file.string(), rates = text(scene.servo.rate) + " Hz";
  const std::string own = " (" + text(info.rate_hz) + " Hz)", nearest = "; expected " + text(info.rate_hz) + " Hz";
  const bool paced = scene.servo.pace == scene::Pace::kDevice;
  if (paced && (info.capabilities & HDV_C_PACING) == 0)
    document::report(problems, file, 0, 0, "servo.pace",
                     "the samples of " + device.name +
                         " cannot drive the loop, because the arm gives one whenever it is asked; unless another arm "
                         "can, the clock drives the loop; expected clock");
  if (info.rate_hz <= 0) return;
  const double ratio = scene.servo.rate / info.rate_hz;
  if (paced && (ratio > kSlack || ratio < 1 / kSlack))
    document::report(problems, file, 0, 0, "servo.rate",
                     "the rate is " + rates + ", but the samples of " + device.name + own +
                         " drive the loop, so budgets and estimators are made for the wrong rate" + nearest);
  else if (ratio > kSlack && (info.capabilities & HDV_C_SIMULATED) == 0)
    document::report(
        problems, file, 0, 0, "servo.rate",
        rates + " is faster than the samples of " + device.name + own + ": some ticks get no new sample" + nearest);
}

/// Returns " (ball.csv:3)" for a row of the file of a path, or "" if the file does not have this row any more.
/// @param t [s] time in this row
std::string lineOf(const std::filesystem::path& csv, size_t row, double t) {
  const auto line = scene::lineOfRow(csv, row, t);
  return line ? " (" + csv.filename().string() + ":" + std::to_string(*line) + ")" : "";
}

/// Returns advice if the positions of a path that is too fast seem to be in mm; else "".
std::string seemInMillimetres(const std::vector<scene::PathPoint>& path, double speed) {
  constexpr double kFar = 1, kThousandth = 1e-3;  // [m] no hand feels a model that is farther away
  double farthest = 0;
  for (const scene::PathPoint& point : path)
    farthest = std::max(farthest, point.pose.position.lpNorm<Eigen::Infinity>());
  if (farthest <= kFar || speed * kThousandth > servo::MinimumJerk::kMostSpeed) return "";
  return "; positions must be in m: " + text(farthest) + " mm is " + text(farthest * kThousandth) + " m";
}

/// The largest of several speeds or turning rates, and the point of the path at which it begins.
struct Fastest {
  double rate = 0;
  size_t point = 0;
  void take(double now, size_t from) {
    if (now <= rate * (1 + 1e-9)) return;  // the first among equals
    rate = now;
    point = from;
  }
};

}  // namespace

document::Problems unstableSettings(const scene::Scene& scene, const scene::Device& device, const hdv_info& info,
                                    const std::vector<double>& stiffness) {
  document::Problems problems;
  const double period = 1 / scene.servo.rate;
  const double alone =
      info.mass_kg > 0 ? passivity::maxStiffnessAlone(info.mass_kg, windowOf(scene.servo.velocity), period) : 0;
  for (size_t i = 0; i < scene.models.size() && i < stiffness.size(); ++i) {
    checkModel(scene, i, device, info, alone, stiffness[i], problems);
    checkDamping(scene, i, device, info, problems);
  }
  const std::string file = scene.file.string();
  if (scene.servo.budget_us > period * 1e6)
    document::report(problems, file, 0, 0, "servo.budget_us",
                     text(scene.servo.budget_us) + " us is longer than the period of " + text(period * 1e6) +
                         " us, so every tick may be late; expected at most " + text(0.8 * period * 1e6) + " us");
  checkHeat(device, info, problems);
  checkLoopRate(scene, device, info, problems);
  return problems;
}

document::Problems fastPaths(const scene::Scene& scene) {
  document::Problems problems;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const std::vector<scene::PathPoint>& path = scene.models[i].path;
    Fastest speed, turn;
    for (size_t k = 1; k < path.size(); ++k) {
      const scene::PathPoint &from = path[k - 1], &to = path[k];
      const double time = to.t - from.t;
      speed.take((to.pose.position - from.pose.position).norm() / time, k - 1);
      turn.take(to.pose.orientation.angularDistance(from.pose.orientation) / time, k - 1);
    }
    const std::string key = "models[" + std::to_string(i) + "].path";
    const auto judge = [&](const char* does, const Fastest& fastest, double most, const char* unit,
                           const std::string& advice) {
      if (fastest.rate <= most * 1.001) return;
      const scene::PathKey at = scene::keyOfPath(scene.models[i]);
      document::report(problems, at.place, key,
                       scene.models[i].name + " " + does + " at up to " + text(fastest.rate) + unit + ", from t = " +
                           text(path[fastest.point].t) + " s" + lineOf(at.csv, fastest.point, path[fastest.point].t) +
                           ", and a path does not yield to a hand; expected at most " + text(most) + unit +
                           ", the limit of ctl move" + advice);
    };
    judge("moves", speed, servo::MinimumJerk::kMostSpeed, " m/s", seemInMillimetres(path, speed.rate));
    judge("turns", turn, servo::MinimumJerk::kMostTurn, " rad/s", "");
  }
  return problems;
}

std::string overheating(const std::string& device, double sustained, const std::vector<double>& forces, double rate,
                        const std::string& pusher) {
  if (sustained <= 0 || forces.empty()) return "";
  double heat = 0;
  for (const double force : forces) heat += force * force;
  const double effective = std::sqrt(heat / static_cast<double>(forces.size()));
  if (effective <= sustained) return "";
  return device + " gave " + text(effective) + " N (root of the mean square of the last " +
         text(std::round(static_cast<double>(forces.size()) / rate)) + " s) and sustains " + text(sustained) +
         " N (device.continuous_force): real motors would overheat; " +
         (pusher.empty()
              ? "use a softer model, or write limits.force: " + text(sustained) + " in the device file"
              : "no model was touched, and " + pusher +
                    " pushed: let it push less, or write clients.max_force: " + text(sustained) + " in the scene");
}

}  // namespace hapticd::tune
