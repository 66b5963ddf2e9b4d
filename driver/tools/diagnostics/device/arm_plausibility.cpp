// SPDX-License-Identifier: MIT
#include "diagnostics/device/arm_plausibility.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "diagnostics/device/rest_joints.hpp"
#include "diagnostics/reading/given_values.hpp"
#include "servo/arm/weight.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// The device file, and what its arm says about itself: when opened if it is simulated, otherwise as the file claims.
struct ArmUnderCheck {
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

hdv_info infoOf(const scene::Device& device, host::DeviceInstance* arm) {
  hdv_info info{};
  if (device.module == "simulated" && arm != nullptr && arm->open()) return arm->info();
  info.max_force = numberIn(device.parameters, "device.max_force");
  info.continuous_force = numberIn(device.parameters, "device.continuous_force");
  info.max_stiffness = numberIn(device.parameters, "device.max_stiffness");
  info.mass_kg = numberIn(device.parameters, "device.mass");
  return info;
}

void checkForce(const ArmUnderCheck& arm_file, const Node* at, const char* key, double force) {
  // [N] less than the friction of most arms; more than a hand can resist
  constexpr double kUnfelt = 0.05, kMost = 300;
  if (at == nullptr || force <= 0) return;
  if (force < kUnfelt)
    return arm_file.warn(
        *at, key,
        fmt::format(
            "{0:g} N cannot be felt, because most arms have more friction; the value must be in N: {0:g} kN is {1:g} N",
            force, force * 1000));
  if (force > kMost && !arm_file.knows(key))
    arm_file.warn(
        *at, key,
        fmt::format("{0:g} N would throw the hand that holds the arm; the value must be in N: {0:g} mN is {1:g} N",
                    force, force / 1000));
}

void checkForces(const ArmUnderCheck& arm_file) {
  const hdv_info& info = arm_file.info;
  const Node* limit = find(arm_file.root, {"limits", "force"});
  checkForce(arm_file, limit, "limits.force", arm_file.device.limits.force);
  const Node* most = find(arm_file.root, {"parameters", "device", "max_force"});
  checkForce(arm_file, most, "parameters.device.max_force", info.max_force);
  if (limit != nullptr && info.max_force > 0 && arm_file.device.limits.force > info.max_force &&
      !arm_file.knows("limits.force"))
    arm_file.warn(*limit, "limits.force",
                  fmt::format("{:g} N is more than the {:g} N of the arm, expected no more",
                              arm_file.device.limits.force, info.max_force));
  if (const Node* sustained = find(arm_file.root, {"parameters", "device", "continuous_force"});
      sustained != nullptr && info.max_force > 0 && info.continuous_force > info.max_force)
    arm_file.warn(
        *sustained, "parameters.device.continuous_force",
        fmt::format("{:g} N for any length of time is more than the {:g} N of device.max_force; expected no more",
                    info.continuous_force, info.max_force));
}

void checkStiffness(const ArmUnderCheck& arm_file) {
  // [N/m] 0.05 N at a depth of 10 mm; twice the stiffness of arms with steel gears
  constexpr double kUnfelt = 5, kMost = 2e5;
  const Node* at = find(arm_file.root, {"parameters", "device", "max_stiffness"});
  const double given = arm_file.info.max_stiffness;
  if (at == nullptr || given <= 0) return;
  if (given < kUnfelt)
    arm_file.warn(
        *at, "parameters.device.max_stiffness",
        fmt::format("{0:g} N/m cannot be felt: 1 mm gives {1:g} N, and every model would be called too stiff; "
                    "the value must be in N/m: {0:g} N/mm is {2:g} N/m",
                    given, given * 1e-3, given * 1000));
  else if (given > kMost)
    arm_file.warn(
        *at, "parameters.device.max_stiffness",
        fmt::format("{:g} N/m is stiffer than any arm that a hand moves can be, so no model would ever be called "
                    "too stiff; expected the stiffness that was found stable, such as 1000 N/m",
                    given));
}

void checkMass(const ArmUnderCheck& arm_file) {
  constexpr double kMost = 20;  // kg
  const Node* at = find(arm_file.root, {"parameters", "device", "mass"});
  const double mass = arm_file.info.mass_kg;
  if (at == nullptr || mass <= kMost) return;
  arm_file.warn(*at, "parameters.device.mass",
                fmt::format("{0:g} kg is more than a hand can move; the value must be the mass felt at the tip, in kg: "
                            "{0:g} g is {1:g} kg",
                            mass, mass / 1000));
}

/// Warns of a weight far above limits.weight, because the motors carry the weight of the arm only up to that limit, and
/// the hand must carry the rest.
void checkWeight(const ArmUnderCheck& arm_file, const host::DeviceInstance& arm) {
  constexpr double kMostly = 0.5;  // if a smaller share of the weight is carried, the masses are in another unit
  const Node* masses = find(arm_file.root, {"parameters", "arm", "masses"});
  const scene::Limits& limits = arm_file.device.limits;
  const double force = limits.force > 0 ? limits.force : arm_file.info.max_force, most = limits.weight.value_or(force);
  if (masses == nullptr || most <= 0 || arm_file.knows("parameters.arm.masses") || arm_file.knows("limits.force"))
    return;
  const uint32_t joints = arm.kinematics().joint_count;
  const auto q = restJoints(arm_file.root, joints);
  const Eigen::Vector3d down = arm_file.device.mount.orientation.conjugate() * Eigen::Vector3d(0, -9.81, 0);
  servo::Weight::Torques tau{};
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> all(6, joints);
  if (arm.kinematics().gravity(arm.handle(), q.data(), down.data(), tau.data()) < 0 ||
      arm.kinematics().jacobian(arm.handle(), q.data(), all.data()) < 0)
    return;
  const double share = servo::shareWithin(most, tau, all.topRows<3>());
  if (!(share < kMostly)) return;
  if (!(share > 0))
    return arm_file.warn(*masses, "parameters.arm.masses",
                         "no force at the tip holds the weight of these masses at rest, because no joint carries it "
                         "there; check the columns of arm.dh, calibration.pose and the masses, which must be in kg");
  arm_file.warn(
      *masses, "parameters.arm.masses",
      fmt::format("these masses weigh {:.3g} N at the tip at rest, but the motors may carry only {:g} N of it "
                  "({}), so the arm would sink onto the hand; masses must be in kg: 30 g is 0.03 kg",
                  most / share, most, limits.weight ? "limits.weight" : "limits.force"));
}

/// Warns of counts of a simulated encoder that are so coarse that the tip visibly jumps.
void checkCounts(const ArmUnderCheck& arm_file) {
  constexpr double kCoarse = 1e-3;  // m
  const Node *joint = find(arm_file.root, {"parameters", "joint"}),
             *counts = find(arm_file.root, {"parameters", "joint", "counts"});
  if (joint == nullptr || arm_file.info.resolution_m <= kCoarse) return;
  const Node& at = counts != nullptr ? *counts : *joint;
  arm_file.warn(
      at, "parameters.joint.counts",
      fmt::format("one count moves the tip by {:.3g} mm; expected the counts of one motor turn, such as 4000; "
                  "joint.gear must be the motor turns of one joint turn, such as 10",
                  arm_file.info.resolution_m * 1e3));
}

/// Warns of two links that are too short for a hand, or of very different lengths, because the tip then cannot come
/// near the shoulder.
void checkLengths(const ArmUnderCheck& arm_file) {
  constexpr double kUnlike = 5, kShort = 0.05;  // [m]
  const Node *lengths = find(arm_file.root, {"parameters", "arm", "lengths"}),
             *kind = find(arm_file.root, {"parameters", "arm", "kind"});
  if (lengths == nullptr || kind == nullptr || kind->scalar != "phantom" || lengths->items.size() < 2) return;
  const double a = document::toNumber(lengths->items[0].scalar).value_or(0),
               b = document::toNumber(lengths->items[1].scalar).value_or(0), less = std::min(a, b),
               more = std::max(a, b);
  if (less > 0 && more < kShort)
    return arm_file.warn(*lengths, "parameters.arm.lengths",
                         fmt::format("the links have {:g} m and {:g} m: the tip reaches {:.3g} mm from its shoulder; "
                                     "is the decimal point wrong? The values must be in m: 20 cm is 0.2 m",
                                     a, b, (a + b) * 1e3));
  if (less <= 0 || more < kUnlike * less) return;
  const Node& at = lengths->items[a < b ? 0 : 1];
  arm_file.warn(
      at, fmt::format("parameters.arm.lengths[{}]", a < b ? 0 : 1),
      fmt::format(
          "this link has {:g} m, but the other one has {:g} m: the tip never comes nearer to its shoulder than {:.3g} "
          "m; expected links of about the same length, in m",
          less, more, more - less));
}

/// Warns of centres of mass beyond the ends of their links. A centre beyond the far end mostly has the wrong sign, and
/// then the motors carry about three times the weight: they push the arm up.
void checkCenters(const ArmUnderCheck& arm_file) {
  // Shares of a link's length: a tool may stand out a little, and a counterweight lies behind the near end.
  constexpr double kBeyondFar = -0.1, kBehindNear = 1.5;
  const Node* list = find(arm_file.root, {"parameters", "arm", "centers"});
  const auto& given = arm_file.device.parameters;
  const scene::Value *dh = givenIn(given, "arm.dh"), *of_links = givenIn(given, "arm.centers");
  const scene::Value* tip = givenIn(given, "arm.tool_position");
  if (list == nullptr || dh == nullptr || of_links == nullptr) return;
  const std::vector<double>*rows = &dh->numbers, *centers = &of_links->numbers, *tool = tip ? &tip->numbers : nullptr;
  for (size_t i = 0; 4 * i + 3 < rows->size() && 3 * i + 2 < centers->size() && i < list->items.size(); ++i) {
    const double a = (*rows)[4 * i], alpha = (*rows)[4 * i + 1], d = (*rows)[4 * i + 2];
    const Eigen::Vector3d back(-a, -d * std::sin(alpha), -d * std::cos(alpha));  // from the far to the near end
    const double length = back.norm();
    if (!(length > 0)) continue;
    const Eigen::Vector3d center = Eigen::Map<const Eigen::Vector3d>(centers->data() + 3 * i);
    const double at = center.dot(back) / (length * length);  // 0 at the far end, 1 at the near end
    double far = 0;
    if (tool != nullptr && tool->size() == 3 && 4 * i + 4 >= rows->size())
      far = std::min(0.0, Eigen::Map<const Eigen::Vector3d>(tool->data()).dot(back) / (length * length));
    if (at >= far + kBeyondFar && at <= kBehindNear) continue;
    const bool turned = at < 0 && at >= -1;  // with the other sign it lies on the link
    const Eigen::Vector3d meant = turned ? Eigen::Vector3d(-center) : Eigen::Vector3d(back / 2);
    arm_file.warn(
        list->items[i], fmt::format("parameters.arm.centers[{}]", i),
        fmt::format("the centre of mass lies {:.3g} m beyond the {} end of link {}, which is {:g} m long; expected a "
                    "place on the link, in its frame, from its far end: {} [{:g}, {:g}, {:g}], in m",
                    length * (at < 0 ? -at : at - 1), at < 0 ? "far" : "near", i + 1, length,
                    turned ? "with the other sign" : "such as its middle", meant.x() + 0.0, meant.y() + 0.0,
                    meant.z() + 0.0));
  }
}

}  // namespace

void warnOfImplausibleArm(const Node& root, const scene::Device& device, host::DeviceInstance* arm,
                          document::Problems& warnings) {
  const ArmUnderCheck arm_file{root, device, infoOf(device, arm), warnings};
  checkForces(arm_file);
  checkStiffness(arm_file);
  checkMass(arm_file);
  if (arm != nullptr) checkWeight(arm_file, *arm);
  if (arm != nullptr) checkCounts(arm_file);
  checkLengths(arm_file);
  checkCenters(arm_file);
}

}  // namespace hapticd::diagnostics
