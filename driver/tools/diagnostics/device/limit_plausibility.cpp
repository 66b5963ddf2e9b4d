// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <string>

#include "diagnostics/device/arm_plausibility.hpp"
#include "diagnostics/device/device_wire.hpp"
#include "diagnostics/device/rest_joints.hpp"
#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// The parsed device file, and the force to which its limits are compared.
struct Bounds {
  const Node& root;
  const scene::Device& device;
  double force;  ///< [N]
  document::Problems& warnings;

  double number(const char* id, double otherwise) const { return numberIn(device.parameters, id, otherwise); }
  bool knows(const std::string& key) const {
    return std::any_of(warnings.begin(), warnings.end(), [&](const auto& one) { return one.key == key; });
  }
  void warn(std::initializer_list<const char*> path, const std::string& what) const {
    const Node* at = find(root, path);
    std::string key;
    for (const char* part : path) key += (key.empty() ? "" : ".") + std::string(part);
    if (at != nullptr) document::report(warnings, device.file.string(), at->line, at->column, key, what);
  }
};

/// Warns of limits that leave almost no force, or that no arm ever reaches.
void checkVelocity(const Bounds& of) {
  constexpr double kStill = 0.2;  // [m/s] a slow move of a hand
  constexpr double kFast = 20;    // [m/s] faster than any arm
  const double velocity = of.device.limits.velocity.value_or(0);
  if (of.device.limits.velocity && velocity == 0)
    of.warn({"limits", "velocity"},
            "0 means no limit, so a position that jumps by less than 20 m/s is never a fault; remove the key for the "
            "default (5 m/s on real hardware), or give m/s, such as 2");
  if (velocity > 0 && velocity < kStill)
    of.warn({"limits", "velocity"},
            fmt::format("a hand moves at 0.1 to 1 m/s, so with {:g} m/s its first stroke would be a "
                        "fault; the value must be in m/s, such as 2",
                        velocity));
  if (velocity > kFast)
    of.warn({"limits", "velocity"},
            fmt::format("{0:g} m/s is faster than any hand or arm, so faulty encoders are never "
                        "noticed; the value must be in m/s: {0:g} mm/s is {1:g} m/s",
                        velocity, velocity / 1000));
}

/// Warns of a bound of growth that is switched off. Both have defaults, because they bound every blow.
void checkGrowth(const Bounds& of) {
  const scene::Limits& limits = of.device.limits;
  const scene::Limits usual;
  if (limits.slew == 0)
    of.warn({"limits", "slew"},
            fmt::format("0 means no limit, so a wrong force begins as a blow; remove the key for the default "
                        "({:g} N/s), or give N/s",
                        usual.slew));
  if (limits.torque_slew == 0)
    of.warn({"limits", "torque_slew"},
            fmt::format("0 means no limit, so a wrong torque begins as a blow; remove the key for the default "
                        "({:g} N m/s), or give N m/s",
                        usual.torque_slew));
}

void checkDynamics(const Bounds& of) {
  constexpr double kSlow = 0.2;     // [s] a force that rises more slowly does not feel hard
  constexpr double kHand = 0.1;     // [m/s] a calm hand
  constexpr double kLittle = 0.05;  // share of the force that cannot be felt
  constexpr double kSmall = 0.02;   // [m] less than a finger moves
  const scene::Limits& limits = of.device.limits;
  if (limits.slew > 0 && of.force / limits.slew > kSlow)
    of.warn({"limits", "slew"},
            fmt::format(
                "with {0:g} N/s a force of {1:g} N takes {2:.3g} s to rise, so nothing feels hard; the value must be "
                "in N/s: {0:g} N/ms is {3:g} N/s",
                limits.slew, of.force, of.force / limits.slew, 1000 * limits.slew));
  if (limits.power > 0 && limits.power < kLittle * of.force * kHand)
    of.warn({"limits", "power"},
            fmt::format(
                "{:g} W allows {:.2g} N at {:g} m/s, which cannot be felt (limits.force is {:g} N); the value must be "
                "in W, such as {:g}",
                limits.power, limits.power / kHand, kHand, of.force, of.force));
  if (limits.impulse > 0 && limits.impulse < kLittle * of.force * 0.1)
    of.warn({"limits", "impulse"},
            fmt::format("{:g} N s within 0.1 s is {:.2g} N, which cannot be felt (limits.force is "
                        "{:g} N); the value must be in N s, such as {:.2g}",
                        limits.impulse, limits.impulse / 0.1, of.force, 0.1 * of.force));
  if (limits.workspace > 0 && limits.workspace < kSmall && !of.knows("limits.workspace"))
    of.warn(
        {"limits", "workspace"},
        fmt::format("forces end {0:g} m from the origin of the arm's frame, and a hand is farther away at once; the "
                    "value must be the radius of the workspace in m, such as 0.15",
                    limits.workspace));
}

void checkCarried(const Bounds& of) {
  constexpr double kTimes = 10, kMuch = 50;  // multiple of limits.force; [N]
  const double weight = of.device.limits.weight.value_or(0);
  if (weight > kMuch && weight > kTimes * of.force)
    of.warn(
        {"limits", "weight"},
        fmt::format(
            "up to {:g} N at the tip may carry the arm's own weight, but shapes push with {:g} N at most: wrong masses "
            "would throw the arm; the value must be in N, about the weight of the arm at its tip",
            weight, of.force));
}

/// Warns of admittance control on an arm whose wire format has no measured torques or no references for joints.
void checkCompliance(const Bounds& of, const codec::Wire& wire) {
  if (!of.device.admittance) return;
  const bool measures = wire.input.has(codec::Role::kTorque), follows = wire.output.has(codec::Role::kReference);
  if (!measures || !follows)
    of.warn({"admittance"},
            fmt::format(
                "{} has no field {{is: {}}}, so a run refuses admittance; add this field if the arm measures torques "
                "and follows references, or remove admittance",
                measures ? "wire.output" : "wire.input", measures ? "reference" : "torque"));
}

/// Warns if only one of the two reports has an id, because a HID device numbers all of its reports or none.
void checkIds(const Bounds& of, const codec::Wire& wire) {
  if (of.device.module != "usb_hid" || (wire.input.id >= 0) == (wire.output.id >= 0)) return;
  const bool in = wire.input.id >= 0;
  of.warn({"parameters", "wire", in ? "input" : "output", "id"},
          fmt::format(
              "is {}, but wire.{} has no id, and a HID device numbers all of its reports or none; add the id there, or "
              "remove this one",
              in ? wire.input.id : wire.output.id, in ? "output" : "input"));
}

/// Warns of a clock whose count is longer than the time between reports, because its unit is then probably wrong.
void checkDeviceClock(const Bounds& of, const codec::Wire& wire) {
  const Node* fields = find(of.root, {"parameters", "wire", "input", "fields"});
  for (size_t i = 0; i < wire.input.fields.size() && fields != nullptr && i < fields->items.size(); ++i) {
    const codec::Field& field = wire.input.fields[i];
    if (field.role != codec::Role::kTime || field.type == codec::Type::kFloat || field.scale * wire.rate <= 1.5)
      continue;
    const Node *scale = fields->items[i].find("scale"), *at = scale != nullptr ? scale : &fields->items[i];
    document::report(
        of.warnings, of.device.file.string(), at->line, at->column,
        fmt::format("parameters.wire.input.fields[{}].scale", i),
        fmt::format(
            "one count of the arm's clock is {:g} s, and a report comes every {:g} s; the value must be the seconds "
            "of one count: 1e-6 for microseconds, 0.001 for milliseconds",
            field.scale, 1 / wire.rate));
  }
}

/// Friction, mass and delay of the joints of a simulated arm, as felt at its tip.
struct Joint {
  const Bounds& of;
  const Eigen::Matrix3Xd& lever;  ///< [m] that the tip moves for each rad

  double number(const char* id, Eigen::Index joint, double otherwise) const {
    const scene::Value* value = givenIn(of.device.parameters, id);
    if (value == nullptr) return otherwise;
    if (value->numbers.empty()) return value->number;
    return value->numbers[std::min<size_t>(joint, value->numbers.size() - 1)];
  }
  void judge(Eigen::Index joint) const {
    constexpr double kHand = 0.1, kHeavy = 20;  // [m/s]; [kg]
    const double arm = lever.col(joint).norm(), gear = number("joint.gear", joint, 1);
    if (!(arm > 1e-3)) return;
    const double friction = number("joint.friction", joint, 0) / arm;
    const double drag = number("joint.damping", joint, 0) * kHand / (arm * arm);
    const double mass = number("joint.rotor", joint, 0) * gear * gear / (arm * arm);
    if (friction > of.force)
      of.warn({"parameters", "joint", "friction"}, fmt::format("joint {} has a friction of {:.3g} N at the tip, more "
                                                               "than the {:g} N with which shapes push, so they cannot "
                                                               "be felt; the value must be in N m: 5 mN m is 0.005 N m",
                                                               joint + 1, friction, of.force));
    if (drag > of.force)
      of.warn({"parameters", "joint", "damping"},
              fmt::format(
                  "joint {} drags with {:.3g} N at {:g} m/s of the tip, more than the {:g} N with which shapes push; "
                  "the value must be in N m s/rad, such as 0.005",
                  joint + 1, drag, kHand, of.force));
    if (mass > kHeavy)
      of.warn({"parameters", "joint", "rotor"},
              fmt::format(
                  "with joint.gear {:g} the motor of joint {} feels like {:.3g} kg at the tip; the value must be in kg "
                  "m^2 before the gear: 1 g cm^2 is 1e-7",
                  gear, joint + 1, mass));
  }
};

/// Warns of a delay with which contacts swing up. A spring with a delay is stable only while its stiffness is less than
/// the damping divided by the delay, and only the hand damps a simulated arm.
void checkDelay(const Bounds& of) {
  constexpr double kRate = 1000, kHold = 0.5, kSoft = 800;  // [Hz] of a servo; [ticks]; [N/m] as most models
  const double late = of.number("delay", 0), damping = of.number("hand.damping", 5);
  const double stable = damping * kRate / (late + kHold);
  if (!(late > 1) || !(stable < kSoft)) return;
  of.warn({"parameters", "delay"},
          fmt::format(
              "{0:g} reads are {0:g} ms at 1000 Hz: with hand.damping {1:g} N s/m, models that are stiffer than about "
              "{2:.3g} N/m may bounce; the value must be a number of reads, such as 1",
              late, damping, stable));
}

/// Warns of joints that rub, weigh or drag more than shapes push.
void checkTwin(const Bounds& of, const host::DeviceInstance& arm) {
  const uint32_t joints = arm.kinematics().joint_count;
  const auto q = restJoints(of.root, joints);
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> J(6, joints);
  const Eigen::Matrix3Xd lever = arm.kinematics().jacobian(arm.handle(), q.data(), J.data()) < 0
                                     ? Eigen::Matrix3Xd::Zero(3, joints)
                                     : Eigen::Matrix3Xd(J.topRows<3>());
  const Joint joint{of, lever};
  const size_t before = of.warnings.size();
  for (Eigen::Index i = 0; i < lever.cols() && of.warnings.size() == before; ++i) joint.judge(i);
}

/// Warns of times and rates of a simulated arm with which nothing can be felt.
void checkRates(const Bounds& of) {
  constexpr double kTick = 1e-3, kLag = 0.02, kFew = 100;  // [s]; [s]; [Hz]
  if (const double step = of.number("substep", 0); step > kTick)
    of.warn({"parameters", "substep"},
            fmt::format(
                "{0:g} s is longer than a tick, so the arm moves in jumps; the value must be in s: 0.2 ms is 0.0002 s",
                step));
  if (const double lag = of.number("joint.motor_lag", 0); lag > kLag)
    of.warn({"parameters", "joint", "motor_lag"},
            fmt::format("the motors push {0:g} s after a command; the value must be in s: {0:g} ms is {1:g} s", lag,
                        lag / 1000));
  if (const double rate = of.number("device.rate", 1000); rate < kFew)
    of.warn({"parameters", "device", "rate"},
            fmt::format("no hand feels a shape at {0:g} Hz; the value must be in Hz: {0:g} kHz is {1:g} Hz", rate,
                        rate * 1000));
  checkDelay(of);
}

}  // namespace

void warnOfImplausibleLimits(const Node& root, const scene::Device& device, const host::DeviceInstance* arm,
                             document::Problems& warnings) {
  double force = device.limits.force;
  if (const double own = numberIn(device.parameters, "device.max_force"); own > 0)
    force = force > 0 ? std::min(force, own) : own;
  if (!(force > 0)) force = 5;  // [N] a usual force of such arms, if no key gives one
  const Bounds bounds{root, device, force, warnings};
  checkGrowth(bounds);
  checkDynamics(bounds);
  checkVelocity(bounds);
  checkCarried(bounds);
  if (device.module == "simulated") checkRates(bounds);
  if (const auto draft = wireDraftOf(device, 0)) checkDeviceClock(bounds, *draft);
  if (arm == nullptr) return;
  if (device.module == "simulated") checkTwin(bounds, *arm);
  const auto wire = wireOf(device, arm->kinematics().joint_count);
  if (!wire) return;
  checkCompliance(bounds, *wire);
  checkIds(bounds, *wire);
}

}  // namespace hapticd::diagnostics
