// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>

#include "diagnostics/limit_advice.hpp"
#include "diagnostics/node_path.hpp"
#include "diagnostics/unusual_arm.hpp"
#include "diagnostics/wire_of.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// One file, and the force that its limits are measured by.
struct Bounds {
  const Node& root;
  const scene::Device& device;
  double force;  ///< [N]
  document::Problems& warnings;

  void warn(std::initializer_list<const char*> path, const std::string& what) const {
    const Node* at = find(root, path);
    std::string key;
    for (const char* part : path) key += (key.empty() ? "" : ".") + std::string(part);
    if (at != nullptr) document::report(warnings, device.file.string(), at->line, at->column, key, what);
  }
};

/// Limits that leave nothing of the force, or that no arm comes to.
void judgeDynamics(const Bounds& of) {
  constexpr double kSlow = 0.2, kHand = 0.1, kLittle = 0.05;  // s; m/s; share of the force
  constexpr double kStill = 0.2, kFast = 20;                  // m/s: a hand's slow moves; faster than any arm
  const scene::Limits& limits = of.device.limits;
  if (limits.slew > 0 && of.force / limits.slew > kSlow)
    of.warn({"limits", "slew"},
            fmt::format("{0:g} N/s: a force of {1:g} N takes {2:.3g} s to come, so nothing feels hard; expected N/s: "
                        "{0:g} N/ms are {3:g} N/s",
                        limits.slew, of.force, of.force / limits.slew, 1000 * limits.slew));
  if (limits.power > 0 && limits.power < kLittle * of.force * kHand)
    of.warn({"limits", "power"},
            fmt::format("{:g} W are {:.2g} N at {:g} m/s, which cannot be felt beside limits.force "
                        "of {:g} N; expected W, such as {:g}",
                        limits.power, limits.power / kHand, kHand, of.force, of.force));
  if (limits.impulse > 0 && limits.impulse < kLittle * of.force * 0.1)
    of.warn({"limits", "impulse"}, fmt::format("{:g} N s within 0.1 s are {:.2g} N, which cannot be felt beside "
                                               "limits.force of {:g} N; expected N s, such as {:.2g}",
                                               limits.impulse, limits.impulse / 0.1, of.force, 0.1 * of.force));
  const double velocity = limits.velocity.value_or(0);
  if (velocity > 0 && velocity < kStill)
    of.warn({"limits", "velocity"},
            fmt::format("{:g} m/s: a hand moves at 0.1 to 1 m/s, so its first stroke would be a "
                        "fault; expected m/s, such as 2",
                        velocity));
  if (velocity > kFast)
    of.warn({"limits", "velocity"},
            fmt::format("{0:g} m/s is faster than any hand or arm, so nothing is ever told of wild "
                        "encoders; expected m/s: {0:g} mm/s are {1:g} m/s",
                        velocity, velocity / 1000));
}

void judgeCarried(const Bounds& of) {
  constexpr double kTimes = 10, kMuch = 50;  // of limits.force; N
  const double weight = of.device.limits.weight.value_or(0);
  if (weight > kMuch && weight > kTimes * of.force)
    of.warn({"limits", "weight"},
            fmt::format(
                "{:g} N at the tip may carry the arm's own weight, and shapes push with {:g} N at most: wrong masses "
                "would throw the arm; expected N, about what it weighs at its tip",
                weight, of.force));
}

/// Compliance needs measured torques, and joints that follow references: the wire format says whether the arm has them.
void judgeCompliance(const Bounds& of, const codec::Wire& wire) {
  if (!of.device.admittance) return;
  const auto has = [](const codec::Report& report, codec::Role role) {
    return std::any_of(report.fields.begin(), report.fields.end(),
                       [role](const auto& one) { return one.role == role; });
  };
  const bool measures = has(wire.input, codec::Role::kTorque), follows = has(wire.output, codec::Role::kReference);
  if (!measures || !follows)
    of.warn({"admittance"},
            fmt::format("{} has no field {{is: {}}}, so a run refuses it; expected an arm that measures "
                        "torques and follows references, or no admittance",
                        measures ? "wire.output" : "wire.input", measures ? "reference" : "torque"));
}

/// HID devices number all of their reports, or none.
void judgeIds(const Bounds& of, const codec::Wire& wire) {
  if (of.device.module != "usb_hid" || (wire.input.id >= 0) == (wire.output.id >= 0)) return;
  const bool in = wire.input.id >= 0;
  of.warn(
      {"parameters", "wire", in ? "input" : "output", "id"},
      fmt::format("{}, and wire.{} has none: a HID device numbers all of its reports or none; expected an id there, or "
                  "none here",
                  in ? wire.input.id : wire.output.id, in ? "output" : "input"));
}

/// A clock that stands still for many reports tells nothing of them: its unit is another.
void judgeClock(const Bounds& of, const codec::Wire& wire) {
  const Node* fields = find(of.root, {"parameters", "wire", "input", "fields"});
  for (size_t i = 0; i < wire.input.fields.size() && fields != nullptr && i < fields->items.size(); ++i) {
    const codec::Field& field = wire.input.fields[i];
    if (field.role != codec::Role::kTime || field.type == codec::Type::kFloat || field.scale * wire.rate <= 1.5)
      continue;
    const Node *scale = fields->items[i].find("scale"), *at = scale != nullptr ? scale : &fields->items[i];
    document::report(
        of.warnings, of.device.file.string(), at->line, at->column,
        fmt::format("parameters.wire.input.fields[{}].scale", i),
        fmt::format("one count of the arm's clock is {:g} s, and a report comes every {:g} s; expected s of "
                    "one count: 1e-6 for microseconds, 0.001 for milliseconds",
                    field.scale, 1 / wire.rate));
  }
}

/// What the joints of a simulated arm rub, weigh and lag, as it is felt at the tip.
struct Joint {
  const Bounds& of;
  const Eigen::Matrix3Xd& lever;  ///< [m] that the tip moves for each rad

  double number(const char* id, Eigen::Index joint, double fallback) const {
    for (const scene::Value& value : of.device.parameters)
      if (value.id == id) {
        if (value.numbers.empty()) return value.number;
        return value.numbers[value.numbers.size() == 1 ? 0 : std::min<size_t>(joint, value.numbers.size() - 1)];
      }
    return fallback;
  }
  void judge(Eigen::Index joint) const {
    constexpr double kHand = 0.1, kHeavy = 20;  // m/s; kg
    const double arm = lever.col(joint).norm(), gear = number("joint.gear", joint, 1);
    if (!(arm > 1e-3)) return;
    const double friction = number("joint.friction", joint, 0) / arm;
    const double drag = number("joint.damping", joint, 0) * kHand / (arm * arm);
    const double mass = number("joint.rotor", joint, 0) * gear * gear / (arm * arm);
    if (friction > of.force)
      of.warn(
          {"parameters", "joint", "friction"},
          fmt::format("joint {} rubs with {:.3g} N at the tip, more than the {:g} N that shapes push with: they cannot "
                      "be felt; expected N m: 5 mN m are 0.005 N m",
                      joint + 1, friction, of.force));
    if (drag > of.force)
      of.warn({"parameters", "joint", "damping"},
              fmt::format(
                  "joint {} drags with {:.3g} N at {:g} m/s of the tip, more than the {:g} N that shapes push with; "
                  "expected N m s/rad, such as 0.005",
                  joint + 1, drag, kHand, of.force));
    if (mass > kHeavy)
      of.warn(
          {"parameters", "joint", "rotor"},
          fmt::format("with joint.gear {:g} the motor of joint {} weighs as much as {:.3g} kg at the tip; expected kg "
                      "m^2 before the gear: 1 g cm^2 is 1e-7",
                      gear, joint + 1, mass));
  }
};

void judgeTwin(const Bounds& of, const host::DeviceInstance& arm) {
  constexpr double kTick = 1e-3, kLag = 0.02, kFew = 100;  // s; s; Hz
  const uint32_t joints = arm.kinematics().joint_count;
  const auto q = restJoints(of.root, joints);
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> J(6, joints);
  const Eigen::Matrix3Xd lever = arm.kinematics().jacobian(arm.handle(), q.data(), J.data()) < 0
                                     ? Eigen::Matrix3Xd::Zero(3, joints)
                                     : Eigen::Matrix3Xd(J.topRows<3>());
  const Joint joint{of, lever};
  const size_t before = of.warnings.size();
  for (Eigen::Index i = 0; i < lever.cols() && of.warnings.size() == before; ++i) joint.judge(i);
  if (const double step = joint.number("substep", 0, 0); step > kTick)
    of.warn(
        {"parameters", "substep"},
        fmt::format("{0:g} s is longer than a tick, so the arm moves in jumps; expected s: 0.2 ms are 0.0002", step));
  if (const double lag = joint.number("joint.motor_lag", 0, 0); lag > kLag)
    of.warn({"parameters", "joint", "motor_lag"},
            fmt::format("{0:g} s: the motors push long after they are told; expected s: {0:g} ms are {1:g} s", lag,
                        lag / 1000));
  if (const double rate = joint.number("device.rate", 0, 1000); rate < kFew)
    of.warn({"parameters", "device", "rate"},
            fmt::format("{0:g} Hz: no hand feels a shape at that rate; expected Hz: {0:g} kHz are {1:g}", rate,
                        rate * 1000));
}

}  // namespace

void unusualLimits(const Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                   document::Problems& warnings) {
  double force = device.limits.force;
  for (const scene::Value& value : device.parameters)
    if (value.id == "device.max_force" && value.number > 0)
      force = force > 0 ? std::min(force, value.number) : value.number;
  if (!(force > 0)) force = 5;  // [N] what a hand's arm gives, where nobody says it
  const Bounds bounds{root, device, force, warnings};
  judgeDynamics(bounds);
  judgeCarried(bounds);
  if (device.module == "simulated") judgeTwin(bounds, arm);
  const auto wire = wireOf(device, arm.kinematics().joint_count);
  if (!wire) return;
  judgeCompliance(bounds, *wire);
  judgeIds(bounds, *wire);
  judgeClock(bounds, *wire);
}

}  // namespace hapticd::diagnostics
