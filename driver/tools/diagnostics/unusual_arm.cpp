// SPDX-License-Identifier: MIT
#include "diagnostics/unusual_arm.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "diagnostics/limit_advice.hpp"
#include "diagnostics/node_path.hpp"
#include "servo/arm/weight.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// The device file, and what its arm says about itself: when opened if it is simulated, otherwise as the file claims.
struct Told {
  const Node& root;
  const scene::Device& device;
  hdv_info info;
  document::Problems& warnings;

  void warn(const Node& at, const std::string& key, const std::string& what) const {
    document::report(warnings, device.file.string(), at.line, at.column, key, what);
  }
  bool knows(const std::string& key) const {
    return std::any_of(warnings.begin(), warnings.end(), [&](const auto& one) { return one.key == key; });
  }
};

double claimed(const scene::Device& device, const char* id) {
  for (const scene::Value& value : device.parameters)
    if (value.id == id) return value.number;
  return 0;
}

hdv_info infoOf(const scene::Device& device, host::DeviceInstance* arm) {
  hdv_info info{};
  if (device.module == "simulated" && arm != nullptr && arm->open()) return arm->info();
  info.max_force = claimed(device, "device.max_force");
  info.continuous_force = claimed(device, "device.continuous_force");
  info.max_stiffness = claimed(device, "device.max_stiffness");
  info.mass_kg = claimed(device, "device.mass");
  return info;
}

void judgeForce(const Told& told, const Node* at, const char* key, double force) {
  // [N] most arms have as much friction; more than a hand can hold against
  constexpr double kUnfelt = 0.05, kMost = 300;
  if (at == nullptr || force <= 0) return;
  if (force < kUnfelt)
    return told.warn(
        *at, key,
        fmt::format(
            "{0:g} N cannot be felt, because most arms have more friction; the value must be in N: {0:g} kN is {1:g} N",
            force, force * 1000));
  if (force > kMost && !told.knows(key))
    told.warn(*at, key,
              fmt::format("{0:g} N throws the hand that holds the arm; the value must be in N: {0:g} mN is {1:g} N",
                          force, force / 1000));
}

void judgeForces(const Told& told) {
  const hdv_info& info = told.info;
  const Node* limit = find(told.root, {"limits", "force"});
  judgeForce(told, limit, "limits.force", told.device.limits.force);
  const Node* most = find(told.root, {"parameters", "device", "max_force"});
  judgeForce(told, most, "parameters.device.max_force", info.max_force);
  if (limit != nullptr && info.max_force > 0 && told.device.limits.force > info.max_force &&
      !told.knows("limits.force"))
    told.warn(*limit, "limits.force",
              fmt::format("{:g} N is more than the {:g} N of the arm, expected no more", told.device.limits.force,
                          info.max_force));
  if (const Node* sustained = find(told.root, {"parameters", "device", "continuous_force"});
      sustained != nullptr && info.max_force > 0 && info.continuous_force > info.max_force)
    told.warn(*sustained, "parameters.device.continuous_force",
              fmt::format("{:g} N for any length of time is more than the {:g} N of device.max_force; expected no more",
                          info.continuous_force, info.max_force));
}

void judgeStiffness(const Told& told) {
  constexpr double kUnfelt = 5, kMost = 2e5;  // N/m: 10 mm of it give 0.05 N; twice what arms of steel gears reach
  const Node* at = find(told.root, {"parameters", "device", "max_stiffness"});
  const double given = told.info.max_stiffness;
  if (at == nullptr || given <= 0) return;
  if (given < kUnfelt)
    told.warn(*at, "parameters.device.max_stiffness",
              fmt::format("{0:g} N/m cannot be felt: 1 mm gives {1:g} N, and every model would be called too stiff; "
                          "the value must be in N/m: {0:g} N/mm is {2:g} N/m",
                          given, given * 1e-3, given * 1000));
  else if (given > kMost)
    told.warn(*at, "parameters.device.max_stiffness",
              fmt::format("{:g} N/m is stiffer than any arm that a hand moves can be, so no model would ever be called "
                          "too stiff; expected the stiffness that was found stable, such as 1000 N/m",
                          given));
}

void judgeMass(const Told& told) {
  constexpr double kMost = 20;  // kg
  const Node* at = find(told.root, {"parameters", "device", "mass"});
  const double mass = told.info.mass_kg;
  if (at == nullptr || mass <= kMost) return;
  told.warn(*at, "parameters.device.mass",
            fmt::format("{0:g} kg is more than a hand can move; the value must be the mass felt at the tip, in kg: "
                        "{0:g} g is {1:g} kg",
                        mass, mass / 1000));
}

/// Warns of a weight far above limits.weight, because the motors carry the weight of the arm only up to that limit, and
/// the hand must carry the rest.
void judgeWeight(const Told& told, const host::DeviceInstance& arm) {
  constexpr double kMostly = 0.5;  // share of the weight that is carried: if it is less, the masses are in another unit
  const Node* masses = find(told.root, {"parameters", "arm", "masses"});
  const scene::Limits& limits = told.device.limits;
  const double force = limits.force > 0 ? limits.force : told.info.max_force, most = limits.weight.value_or(force);
  if (masses == nullptr || most <= 0 || told.knows("parameters.arm.masses") || told.knows("limits.force")) return;
  const uint32_t joints = arm.kinematics().joint_count;
  const auto q = restJoints(told.root, joints);
  const Eigen::Vector3d down = told.device.mount.orientation.conjugate() * Eigen::Vector3d(0, -9.81, 0);
  servo::Weight::Torques tau{};
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> all(6, joints);
  if (arm.kinematics().gravity(arm.handle(), q.data(), down.data(), tau.data()) < 0 ||
      arm.kinematics().jacobian(arm.handle(), q.data(), all.data()) < 0)
    return;
  const double share = servo::shareWithin(most, tau, all.topRows<3>());
  if (!(share < kMostly)) return;
  told.warn(*masses, "parameters.arm.masses",
            fmt::format("these masses weigh {:.3g} N at the tip at rest, but the motors may carry only {:g} N of it "
                        "({}), so the arm would sink onto the hand; masses must be in kg: 30 g is 0.03 kg",
                        most / share, most, limits.weight ? "limits.weight" : "limits.force"));
}

/// Warns of counts of a simulated encoder that are so coarse that the tip visibly jumps.
void judgeCounts(const Told& told) {
  constexpr double kCoarse = 1e-3;  // m
  const Node *joint = find(told.root, {"parameters", "joint"}),
             *counts = find(told.root, {"parameters", "joint", "counts"});
  if (joint == nullptr || told.info.resolution_m <= kCoarse) return;
  const Node& at = counts != nullptr ? *counts : *joint;
  told.warn(at, "parameters.joint.counts",
            fmt::format("one count moves the tip by {:.3g} mm; expected counts of a motor turn, such as 4000, and as "
                        "joint.gear the motor turns of one joint turn, such as 10",
                        told.info.resolution_m * 1e3));
}

/// Warns of two links of very different lengths, because the tip then cannot come near the shoulder.
void judgeLengths(const Told& told) {
  constexpr double kUnlike = 5;
  const Node *lengths = find(told.root, {"parameters", "arm", "lengths"}),
             *kind = find(told.root, {"parameters", "arm", "kind"});
  if (lengths == nullptr || kind == nullptr || kind->scalar != "phantom" || lengths->items.size() < 2) return;
  const double a = document::toNumber(lengths->items[0].scalar).value_or(0),
               b = document::toNumber(lengths->items[1].scalar).value_or(0), less = std::min(a, b),
               more = std::max(a, b);
  if (less <= 0 || more < kUnlike * less) return;
  const Node& at = lengths->items[a < b ? 0 : 1];
  told.warn(at, fmt::format("parameters.arm.lengths[{}]", a < b ? 0 : 1),
            fmt::format("{:g} m, but the other link has {:g} m: the tip never comes nearer to its shoulder than {:.3g} "
                        "m; expected links of about the same length, in m",
                        less, more, more - less));
}

}  // namespace

void unusualArm(const Node& root, const scene::Device& device, host::DeviceInstance* arm,
                document::Problems& warnings) {
  const Told told{root, device, infoOf(device, arm), warnings};
  judgeForces(told);
  judgeStiffness(told);
  judgeMass(told);
  if (arm != nullptr) judgeWeight(told, *arm);
  if (arm != nullptr) judgeCounts(told);
  judgeLengths(told);
}

}  // namespace hapticd::diagnostics
