// SPDX-License-Identifier: MIT
#include "diagnostics/device/safety_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "diagnostics/device/device_wire.hpp"
#include "diagnostics/device/motor_force.hpp"
#include "diagnostics/device/rest_joints.hpp"
#include "diagnostics/device/slow_arm.hpp"
#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {
namespace {

using codec::Field;
using codec::Role;
using document::Node;

/// What all warnings about one file need.
struct File {
  const Node& root;
  const scene::Device& device;
  document::Problems& warnings;
  void warn(const Node& at, const std::string& key, const std::string& what) const {
    document::report(warnings, device.file.string(), at.line, at.column, key, what);
  }
  double number(const char* id) const { return numberIn(device.parameters, id); }
};

void noForceLimit(const File& file, const host::DeviceInstance& arm) {
  if (file.device.limits.force > 0 || file.number("device.max_force") > 0) return;
  const Node* limits = file.root.find("limits");
  const auto reach = forceOfMotors(file.root, file.device, arm);
  file.warn(limits != nullptr ? *limits : file.root, "limits.force",
            "not given, and neither is parameters.device.max_force, so only the motors bound the force" +
                (reach ? fmt::format(": about {:.3g} N at rest", *reach) : std::string()) +
                "; expected what a hand may feel, such as 0.5 N to begin with");
}

/// Warns of a missing limits.torque. An arm of more than three joints can turn the hand, and no device reports the
/// largest torque at its handle.
void noTorqueLimit(const File& file, const codec::Wire& wire, const host::DeviceInstance& arm) {
  constexpr double kHandle = 0.1;  // [m] lever arm at which a hand holds the handle
  const scene::Limits& limits = file.device.limits;
  const bool turns =
      arm.kinematics().joint_count > 3 && (wire.output.has(Role::kTorque) || wire.output.has(Role::kReference));
  if (!turns || limits.torque > 0) return;
  const Node* given = file.root.find("limits");
  const double force = limits.force > 0 ? limits.force : file.number("device.max_force");
  file.warn(
      given != nullptr ? *given : file.root, "limits.torque",
      "not given, so only the motors bound the torque on the hand; expected a torque that a wrist can bear" +
          (force > 0 ? fmt::format(", such as {:.2g} N m: limits.force at a handle of {:g} m", kHandle * force, kHandle)
                     : ", such as 0.05 N m to begin with"));
}

/// Warns of a torque that has not the sign of its position, because forces then pull the hand in instead of pushing it
/// out. The board of a Falcon reverses all three signs. Another board may reverse one, so one warning for the whole arm
/// is enough, and an arm that was tried has none.
void wrongSigns(const File& file, const codec::Wire& wire) {
  const bool reversed = file.number("loader") > 0;
  if (file.number("device.verified") > 0) return;
  const Node* fields = find(file.root, {"parameters", "wire", "output", "fields"});
  if (fields == nullptr) return;
  std::optional<size_t> first;
  std::string joints;
  for (const Field& in : wire.input.fields)
    for (size_t i = 0; i < std::min(wire.output.fields.size(), fields->items.size()); ++i) {
      const Field& out = wire.output.fields[i];
      if (in.role != Role::kPosition || out.role != Role::kTorque || in.index != out.index) continue;
      if ((in.scale * out.scale > 0) != reversed) continue;
      joints += fmt::format("{}{}", first ? ", " : "", in.index + 1);
      if (!first) first = i;
    }
  if (first)
    file.warn(
        fields->items[*first], fmt::format("parameters.wire.output.fields[{}].scale", *first),
        fmt::format("the scale of this torque and the scale of the position of joint {} have {}, forces pull the hand "
                    "in; check with a very small force first, then set device.verified: true, and this warning ends",
                    joints,
                    reversed ? "the same sign; if the board reverses torques, as a Falcon's is said to do"
                             : "opposite signs; unless the board reverses one of them"));
}

void slowWatchdog(const File& file, const codec::Wire& wire) {
  constexpr double kSlow = 0.1;  // s
  const Node* watchdog = find(file.root, {"parameters", "wire", "watchdog"});
  if (watchdog == nullptr || wire.watchdog <= kSlow) return;
  file.warn(*watchdog, "parameters.wire.watchdog",
            fmt::format("{:g} s is long: when commands stop, the arm keeps its last force for this time; give a time "
                        "in s, such as 0.02",
                        wire.watchdog));
}

/// Warns of samples that come so rarely that the arm pushes less. The servo is assumed to be fast, because its rate is
/// in the scene.
void slowSamples(const File& file, const codec::Wire& wire) {
  constexpr double kServoAtItsBest = 1e4;  // Hz
  const Node* rate = find(file.root, {"parameters", "wire", "rate"});
  if (const std::string slow = slownessOf(file.device, kServoAtItsBest); rate != nullptr && !slow.empty())
    file.warn(*rate, "parameters.wire.rate", fmt::format("{:g} Hz: ", wire.rate) + slow);
}

/// Warns if health.stale is shorter than the time of two reports, because one late report then stops the motors.
void soonStale(const File& file, const codec::Wire& wire) {
  constexpr double kReports = 2;
  const Node* stale = find(file.root, {"parameters", "health", "stale"});
  const double time = file.number("health.stale");
  if (stale == nullptr || !(time > 0) || !(time * wire.rate < kReports)) return;
  file.warn(*stale, "parameters.health.stale",
            fmt::format("{:g} s is shorter than two reports at {:g} Hz, so one late report switches the motors off; "
                        "expected the time of several reports, such as {:.2g}",
                        time, wire.rate, std::min(0.018, std::max(0.005, 5 / wire.rate))));
}

/// Warns of a missing calibration, because encoders that wrap have their zero wherever the arm was switched on.
void noCalibration(const File& file, const codec::Wire& wire) {
  const bool wraps = std::any_of(wire.input.fields.begin(), wire.input.fields.end(),
                                 [](const Field& field) { return field.role == Role::kPosition && field.wraps; });
  if (!wraps || wire.input.has(Role::kCalibrated) || file.number("calibration.method") > 0) return;
  const Node *given = find(file.root, {"parameters", "calibration"}), *parameters = file.root.find("parameters");
  file.warn(given != nullptr ? *given : *parameters, "parameters.calibration.method",
            "is none, but the encoders wrap, so their zero is wherever the arm was switched on; set method: pose (or "
            "device), or remove wraps if the encoders are absolute");
}

void tooHeavy(const File& file, const host::DeviceInstance& arm) {
  const Node* masses = find(file.root, {"parameters", "arm", "masses"});
  const std::vector<double> motors = motorsOf(file.device, arm.kinematics().joint_count);
  if (masses == nullptr || motors.empty()) return;
  const auto q = restJoints(file.root, arm.kinematics().joint_count);
  const double gravity[3] = {0, -9.81, 0};
  std::array<double, HDV_MAX_JOINTS> tau{};
  if (arm.kinematics().gravity(arm.handle(), q.data(), gravity, tau.data()) < 0) return;
  for (size_t i = 0; i < motors.size(); ++i)
    if (std::abs(tau[i]) > motors[i])
      return file.warn(*masses, "parameters.arm.masses",
                       fmt::format("with these masses, joint {} needs {:.3g} N m to hold the arm at rest, but its "
                                   "motor gives only {:g} N m; masses must be in kg",
                                   i + 1, std::abs(tau[i]), motors[i]));
}

/// Returns the keys that a field of this kind reads, including those that every field reads.
std::set<std::string> keysOf(Role role) {
  std::set<std::string> keys{"is", "at", "type", "endian", "bit_offset"};
  const auto add = [&keys](std::initializer_list<const char*> more) { keys.insert(more.begin(), more.end()); };
  if (role == Role::kPosition || role == Role::kVelocity || role == Role::kTorque || role == Role::kReference)
    add({"joint", "scale", "offset", "scale_degrees", "offset_degrees", "limit", "wraps"});
  else if (role == Role::kButton)
    add({"button", "bit", "inverted"});
  else if (role == Role::kFault || role == Role::kCalibrated)
    add({"bit", "inverted"});
  else if (role == Role::kEnable || role == Role::kCalibrate || role == Role::kFollow)
    add({"bit", "inverted", "value"});
  else if (role == Role::kSequence || role == Role::kStarts)
    add({"modulo"});
  else if (role == Role::kConstant || role == Role::kFirmware)
    add({"value"});
  else if (role == Role::kChecksum)
    add({"method", "from", "to", "word", "polynomial", "initial", "reflected", "final_xor", "negated", "over_id"});
  if (role == Role::kTime) add({"scale"});
  return keys;
}

void unusedKeys(const File& file, const codec::Report& report, const char* which) {
  const Node* fields = find(file.root, {"parameters", "wire", which, "fields"});
  if (fields == nullptr || !fields->isSequence()) return;
  for (size_t i = 0; i < report.fields.size() && i < fields->items.size(); ++i) {
    const Field& field = report.fields[i];
    const std::set<std::string> used = keysOf(field.role);
    const std::string key = fmt::format("parameters.wire.{}.fields[{}]", which, i);
    const Node* is = fields->items[i].find("is");
    for (const document::Entry& entry : fields->items[i].entries)
      if (used.count(entry.key.scalar) == 0)
        file.warn(entry.key, key + "." + entry.key.scalar,
                  fmt::format("this key is ignored, because a field that is {} has no {}",
                              is != nullptr ? is->scalar : "this", entry.key.scalar));
    const Node* value = fields->items[i].find("value");
    if (field.role == Role::kEnable && field.bit < 0 && field.value == 0 && value != nullptr)
      file.warn(*value, key + ".value",
                "0 is also sent when the motors are off, so they could never be enabled; give another value");
  }
}

void sameButton(const File& file, const codec::Report& report) {
  const Node* fields = find(file.root, {"parameters", "wire", "input", "fields"});
  std::set<int> known;
  for (size_t i = 0; i < report.fields.size() && fields != nullptr && i < fields->items.size(); ++i)
    if (report.fields[i].role == Role::kButton && !known.insert(report.fields[i].index).second)
      file.warn(fields->items[i], fmt::format("parameters.wire.input.fields[{}].button", i),
                fmt::format("another field is button {} too: either of them is enough to press it",
                            report.fields[i].index + 1));
}

}  // namespace

void warnOfSafety(const Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                  document::Problems& warnings) {
  const File file{root, device, warnings};
  const auto wire = wireOf(device, arm.kinematics().joint_count);
  if (!wire) return tooHeavy(file, arm);  // the rest needs the wire format
  noForceLimit(file, arm);
  noTorqueLimit(file, *wire, arm);
  wrongSigns(file, *wire);
  slowWatchdog(file, *wire);
  slowSamples(file, *wire);
  soonStale(file, *wire);
  noCalibration(file, *wire);
  tooHeavy(file, arm);
  unusedKeys(file, wire->input, "input");
  unusedKeys(file, wire->output, "output");
  sameButton(file, wire->input);
}

}  // namespace hapticd::diagnostics
