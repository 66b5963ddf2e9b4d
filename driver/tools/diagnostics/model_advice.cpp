// SPDX-License-Identifier: MIT
#include "diagnostics/model_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "hapticd/abi.h"

namespace hapticd::diagnostics {
namespace {

using Eigen::Vector3d;

constexpr double kOutOfReach = 5;  ///< [m] farther than anybody reaches
constexpr double kFast = 5;        ///< [m/s] faster than anybody throws what a hand shall feel
constexpr double kHeavy = 100;     ///< [kg] heavier than an arm moves

/// The values that the file gives to one model, and what is said of them.
class Given {
 public:
  Given(const scene::Scene& scene, size_t index, document::Problems& warnings)
      : model_(scene.models[index]), index_(index), warnings_(warnings) {}

  const scene::Value* find(const char* id) const {
    for (const scene::Value& value : model_.parameters)
      if (value.id == id) return &value;
    return nullptr;
  }
  double number(const char* id, double otherwise) const {
    const scene::Value* value = find(id);
    return value != nullptr ? value->number : otherwise;
  }
  Vector3d vector(const char* id, const Vector3d& otherwise) const {
    const scene::Value* value = find(id);
    return value != nullptr && value->numbers.size() == 3 ? Vector3d(value->numbers.data()) : otherwise;
  }
  void warn(const char* id, const std::string& what) const {
    const scene::Value* value = find(id);
    document::report(warnings_, value != nullptr ? value->place : model_.place,
                     fmt::format("models[{}].parameters.{}", index_, id), what);
  }
  const scene::Model& model() const { return model_; }

 private:
  const scene::Model& model_;
  size_t index_;
  document::Problems& warnings_;
};

void lengthOf(const Given& given, const char* id, const char* what) {
  const scene::Value* value = given.find(id);
  if (value == nullptr) return;
  double most = value->numbers.empty() ? std::abs(value->number) : 0;
  for (const double number : value->numbers) most = std::max(most, std::abs(number));
  if (most > kOutOfReach)
    given.warn(id, fmt::format("{:g} m is {}; expected metres: {:g} mm are {:g} m", most, what, most, most / 1000));
}

void massOf(const Given& given) {
  if (const double mass = given.number("mass", 0); mass > kHeavy)
    given.warn("mass", fmt::format("{:g} kg is more than a hand moves; expected kg: {:g} g are {:g} kg", mass, mass,
                                   mass / 1000));
}

void contactOf(const Given& given) {
  constexpr double kRoughest = 2, kDeepest = 0.05, kUnfelt = 0.05;
  for (const char* id : {"friction_static", "friction_dynamic"})
    if (const double ratio = given.number(id, 0); ratio > kRoughest)
      given.warn(id,
                 fmt::format("{:g} is the ratio of friction to pressing force, and of no material (rubber has about "
                             "1): the tip sticks where it touches; expected 0 to {:g}",
                             ratio, kRoughest));
  if (given.number("friction_static", 0) > 0 && given.find("friction_dynamic") == nullptr)
    given.warn("friction_static",
               "holds the tip until it slides, and friction_dynamic, which is not given, is 0: then nothing rubs; "
               "expected both, friction_dynamic a little below it");
  if (const double pop = given.number("pop_through", 0); pop > 0 && pop < kUnfelt)
    given.warn("pop_through",
               fmt::format("{:g} N cannot be felt before the shell gives way; expected N: {:g} mN are {:g} "
                           "N, so perhaps {:g} N",
                           pop, pop, pop / 1000, pop * 1000));
  const double scale = given.number("depth_scale", 0);
  if (scale < kDeepest) return;
  const double share = std::pow(1e-3 / scale, given.number("exponent", 1));
  given.warn(
      "depth_scale",
      fmt::format("{:g} m: only that deep have stiffness and damping what they are given, and at 1 mm damping has "
                  "{:.3g} of it, force {:.3g} of stiffness times depth_scale; expected a depth that a hand "
                  "presses: 1 mm is 0.001 m",
                  scale, share, share));
}

/// Where a body that is drawn to its place by a spring hangs, or falls for ever.
void weightOf(const Given& given, const scene::Scene& scene) {
  constexpr double kHangs = 0.3, kLight = 0.1;  // [m] out of what a hand reaches from its pose; [m/s^2]
  constexpr double kHinge = 1, kSlider = 2;
  const double joint = given.number("joint", 0);
  const Vector3d axis = given.model().pose.orientation * given.vector("axis", Vector3d::UnitY());
  double gravity = scene.servo.gravity.norm();  // that which moves it
  if (joint == kSlider && axis.norm() > 0) gravity = std::abs(scene.servo.gravity.dot(axis.normalized()));
  if (given.number("gravity", 1) == 0 || !(gravity > kLight) || joint == kHinge) return;
  const double weight = given.number("mass", 1) * gravity, tether = given.number("tether", 0);
  if (tether > 0 && weight / tether > kHangs)
    given.warn("tether", fmt::format("{:g} N/m under a weight of {:.3g} N lets the body hang {:.3g} m below its pose; "
                                     "expected a stiffer one, a lighter body (mass, in kg) or gravity: false",
                                     tether, weight, weight / tether));
  if (!(tether > 0))
    given.warn("motion", fmt::format("dynamic and of weight: nothing holds {}, so it falls from the first tick on; "
                                     "expected tether, a joint that bears it or gravity: false",
                                     given.model().name));
}

void bodyOf(const Given& given, const scene::Scene& scene) {
  constexpr double kSpin = 50, kWide = 1, kDynamic = 2;  // [rad/s], [m], of the names of `motion`
  const scene::Value* motion = given.find("motion");
  if (motion == nullptr || motion->number != kDynamic || given.model().kinematic) return;
  massOf(given);
  weightOf(given, scene);
  if (const double speed = given.vector("velocity", Vector3d::Zero()).norm(); speed > kFast)
    given.warn("velocity", fmt::format("{:g} m/s: the body is out of reach before a hand feels it; expected m/s: {:g} "
                                       "mm/s are {:g} m/s",
                                       speed, speed, speed / 1000));
  if (const double spin = given.vector("spin", Vector3d::Zero()).norm(); spin > kSpin)
    given.warn("spin",
               fmt::format("{:g} rad/s are {:.3g} turns a second; expected rad/s: {:g} degrees/s are {:.4g} rad/s",
                           spin, spin / (2 * M_PI), spin, spin * M_PI / 180));
  lengthOf(given, "pivot", "far outside of any body");
  lengthOf(given, "center", "far outside of any body");
  const scene::Value* inertia = given.find("inertia");
  if (inertia == nullptr || inertia->numbers.empty()) return;
  const double most = *std::max_element(inertia->numbers.begin(), inertia->numbers.end());
  if (const double radius = std::sqrt(most / given.number("mass", 1)); radius > kWide)
    given.warn("inertia",
               fmt::format("{:g} kg m^2 with {:g} kg are those of a body {:.3g} m about its center; expected kg "
                           "m^2 (1 kg mm^2 is 1e-6 kg m^2), or [] for that of its volume",
                           most, given.number("mass", 1), radius));
}

void pendulumOf(const Given& given, const scene::Scene& scene) {
  if (given.model().plugin != "pendulum") return;
  if (const double angle = given.number("angle", 0); std::abs(angle) > M_PI * 1.001)
    given.warn("angle", fmt::format("{:g} rad is more than half a turn; expected rad: {:g} degrees are {:.4g} rad",
                                    angle, angle, angle * M_PI / 180));
  lengthOf(given, "pivot", "far outside of any body");
  lengthOf(given, "length", "longer than any arm reaches");
  massOf(given);
  const Vector3d axis = given.model().pose.orientation * given.vector("axis", Vector3d::UnitZ());
  const Vector3d& gravity = scene.servo.gravity;
  constexpr double kAcross = 0.02;  // of the weight that turns it
  if (given.find("axis") != nullptr && axis.norm() > 0 && gravity.norm() > 0 &&
      axis.normalized().cross(gravity.normalized()).norm() < kAcross)
    given.warn("axis",
               "is along gravity, so no weight swings the body back; expected one across gravity, as [0, 0, 1]");
}

void buttonOf(const Given& given) {
  constexpr double kLongest = 0.1;  // [m] of a button under a finger
  const scene::Value* detent = given.find("detent");
  if (given.model().plugin != "push_button" || detent == nullptr) return;
  double travel = 0;
  for (size_t i = 0; i + 1 < detent->numbers.size(); i += 2) travel = std::max(travel, detent->numbers[i]);
  if (travel > kLongest)
    given.warn("detent", fmt::format("a travel of {:g} m is longer than any button's, so no click is reached; expected "
                                     "rows of travel [m] and force [N]: {:g} mm are {:g} m",
                                     travel, travel, travel / 1000));
}

bool same(const scene::Pose& a, const scene::Pose& b) {
  constexpr double kSame = 1e-6;
  return (a.position - b.position).norm() < kSame && a.orientation.angularDistance(b.orientation) < kSame;
}

bool equal(const scene::Value* a, const scene::Value* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->number == b->number && a->text == b->text && a->numbers == b->numbers;
}

/// A copy whose pose was forgotten: both push, so it is felt twice as stiff as it is given.
void copiesOf(const scene::Scene& scene, document::Problems& warnings) {
  constexpr size_t kMostPairs = 1000;  // all pairs of more take long, and nobody writes so many by hand
  if (scene.models.size() > kMostPairs) return;
  for (size_t i = 0; i < scene.models.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const scene::Model &one = scene.models[j], &two = scene.models[i];
      const Given first(scene, j, warnings), second(scene, i, warnings);
      const bool still = one.path.empty() && two.path.empty();
      if (!still || one.plugin != two.plugin || !same(one.pose, two.pose) || first.find("geometry") == nullptr ||
          !equal(first.find("geometry"), second.find("geometry")) ||
          !equal(first.find("instance"), second.find("instance")) || !equal(first.find("sides"), second.find("sides")))
        continue;
      document::report(warnings, two.place, fmt::format("models[{}].pose", i),
                       fmt::format("{} is where {} (line {}) is, with the same geometry: both push, so the surface is "
                                   "felt with the sum of their stiffness; expected another pose",
                                   two.name, one.name, one.place.line));
      break;
    }
}

}  // namespace

document::Problems doubtfulModels(const scene::Scene& scene) {
  document::Problems warnings;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const Given given(scene, i, warnings);
    contactOf(given);
    if (given.model().plugin == "nurbs_rigid") bodyOf(given, scene);
    pendulumOf(given, scene);
    buttonOf(given);
  }
  copiesOf(scene, warnings);
  return warnings;
}

}  // namespace hapticd::diagnostics
