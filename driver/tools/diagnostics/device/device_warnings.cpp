// SPDX-License-Identifier: MIT
#include "diagnostics/device/device_warnings.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnostics/device/arm_plausibility.hpp"
#include "diagnostics/device/arm_table.hpp"
#include "diagnostics/device/corrected_keys.hpp"
#include "diagnostics/device/device_trial.hpp"
#include "diagnostics/device/limit_warnings.hpp"
#include "diagnostics/device/motor_warnings.hpp"
#include "diagnostics/device/mount_warnings.hpp"
#include "diagnostics/device/rest_joints.hpp"
#include "diagnostics/device/safety_warnings.hpp"
#include "diagnostics/device/travel_warnings.hpp"
#include "diagnostics/device/unit_warnings.hpp"
#include "diagnostics/device/wire_warnings.hpp"
#include "diagnostics/reading/given_values.hpp"
#include "document/node.hpp"
#include "document/reader.hpp"
#include "host/device_instance.hpp"
#include "scene/device_draft.hpp"
#include "scene/load.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// Warns of whole-number positions without a scale, because each count would then be a whole radian.
void countsWithoutScale(const Node& root, const std::string& file, document::Problems& warnings) {
  const Node* fields = find(root, {"parameters", "wire", "input", "fields"});
  if (fields == nullptr || !fields->isSequence()) return;
  for (size_t i = 0; i < fields->items.size(); ++i) {
    const Node &field = fields->items[i], *is = find(field, {"is"}), *type = find(field, {"type"});
    if (is == nullptr || is->scalar != "position" || type == nullptr) continue;
    const bool whole = type->scalar.rfind('i', 0) == 0 || type->scalar.rfind('u', 0) == 0;
    if (!whole || field.find("scale") != nullptr || field.find("scale_degrees") != nullptr) continue;
    document::report(warnings, file, field.line, field.column, fmt::format("parameters.wire.input.fields[{}].scale", i),
                     "not given, so each count of this " + type->scalar +
                         " is 1 rad (or 1 m); expected 2 pi / (counts per motor turn * motor turns per joint turn)");
  }
}

/// Warns of an arm with its own lengths but without masses: the weight of another arm would be used, so it would be
/// pushed up, or sag.
void massesOfAnotherArm(const Node& root, const std::string& file, document::Problems& warnings) {
  const Node *lengths = find(root, {"parameters", "arm", "lengths"}), *kind = find(root, {"parameters", "arm", "kind"});
  const bool delta = kind != nullptr && kind->scalar == "delta", chain = kind != nullptr && kind->scalar == "chain";
  if (lengths == nullptr || chain || find(root, {"parameters", "wire"}) == nullptr) return;
  if (find(root, {"parameters", "arm", "masses"}) != nullptr) return;
  document::report(warnings, file, lengths->line, lengths->column, "parameters.arm.masses",
                   fmt::format("not given, so the motors carry the weight of {} instead of this arm's; expected its "
                               "own masses [kg], or masses: [{}] if its weight is not to be carried",
                               delta ? "a Falcon" : "a Premium 1.5", delta ? "0, 0, 0" : "0, 0, 0, 0"));
}

/// Warns of masses without centres. At the far ends of their links they need about twice the torque, so the arm would
/// be pushed up.
void massesAtTheEnds(const Node& root, const std::string& file, document::Problems& warnings) {
  const Node *masses = find(root, {"parameters", "arm", "masses"}), *kind = find(root, {"parameters", "arm", "kind"});
  if (kind == nullptr || kind->scalar != "chain" || masses == nullptr || !masses->isSequence()) return;
  if (find(root, {"parameters", "arm", "centers"}) != nullptr) return;
  const auto weighs = [](const Node& mass) { return document::toNumber(mass.scalar).value_or(0) != 0; };
  if (std::none_of(masses->items.begin(), masses->items.end(), weighs)) return;
  document::report(
      warnings, file, masses->line, masses->column, "parameters.arm.centers",
      "not given, so each of these masses is carried as if it were at the far end of its link, and the arm is pushed "
      "up; expected the centre of mass of each link, [x, y, z] in m from the link's far end, in the link's frame");
}

/// Warns if the calibration pose lies beyond the stops of the arm, because nobody can hold the arm there.
void poseBeyondStops(const Node& root, const scene::Device& device, document::Problems& warnings) {
  const Node* pose = find(root, {"parameters", "calibration", "pose"});
  const scene::Value* limits = givenIn(device.parameters, "arm.limits");
  // Limits in degrees say nothing about a pose; they are reported themselves.
  if (largest(numbersIn(find(root, {"parameters", "arm", "limits"}))) > 2 * M_PI) return;
  if (pose == nullptr || limits == nullptr || 2 * pose->items.size() != limits->numbers.size()) return;
  for (size_t i = 0; i < pose->items.size(); ++i) {
    const double angle = document::toNumber(pose->items[i].scalar).value_or(0);
    const double low = limits->numbers[2 * i], high = limits->numbers[2 * i + 1], room = 0.05 * (high - low);
    const bool degrees = std::abs(angle) > 2 * M_PI;  // this is reported itself
    if (degrees || high < low || (angle >= low - room && angle <= high + room)) continue;
    document::report(warnings, device.file.string(), pose->items[i].line, pose->items[i].column,
                     fmt::format("parameters.calibration.pose[{}]", i),
                     fmt::format("{:g} rad is beyond arm.limits of joint {}, {:g} to {:g} rad: the arm cannot be held "
                                 "there; expected a pose between its stops",
                                 angle, i + 1, low, high));
  }
}

void restOutsideWorkspace(const Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                          document::Problems& warnings) {
  const Node* limit = find(root, {"limits", "workspace"});
  const double radius = device.limits.workspace;
  if (radius <= 0 || limit == nullptr) return;
  const hdv_ext_kinematics& kinematics = arm.kinematics();
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  std::array<double, 4> turn{};
  const auto q = restJoints(root, kinematics.joint_count);
  if (kinematics.forward(arm.handle(), q.data(), tip.data(), turn.data()) < 0 || !tip.allFinite()) return;
  if (tip.norm() <= radius) return;
  document::report(warnings, device.file.string(), limit->line, limit->column, "limits.workspace",
                   fmt::format("{:g} m from the origin of the arm's frame, but at rest its tip is at [{:.3g}, {:.3g}, "
                               "{:.3g}], {:.3g} m away, so no force would be felt there; expected more",
                               radius, tip.x(), tip.y(), tip.z(), tip.norm()));
}

bool isBelow(const std::string& key, const std::string& above) {
  return key.starts_with(above) && (key.size() == above.size() || key[above.size()] == '.' || key[above.size()] == '[');
}

/// Returns true if the geometry of the arm can be trusted, and its module does not crash.
bool kinematicsKnown(const document::Problems& known) {
  return std::none_of(known.begin(), known.end(), [](const document::Problem& one) {
    return one.key == "module" || one.key == "parameters" ||
           (isBelow(one.key, "parameters.arm") && !isBelow(one.key, "parameters.arm.max_torque"));
  });
}

/// Returns the number of joints that a file describes; 0 if it is unknown.
size_t jointsIn(const Node& root) {
  constexpr size_t kOfOthers = 3;
  const Node *kind = find(root, {"parameters", "arm", "kind"}), *rows = find(root, {"parameters", "arm", "dh"}),
             *others = find(root, {"parameters", "arm", "others"}),
             *limits = find(root, {"parameters", "arm", "limits"});
  if (kind == nullptr) return 0;
  if (kind->scalar == "phantom" || kind->scalar == "premium15" || kind->scalar == "delta") return kOfOthers;
  if (kind->scalar != "chain") return 0;
  if (rows == nullptr)  // the table is missing, but arm.limits may show the number of joints
    return limits != nullptr && limits->isSequence() ? std::min<size_t>(limits->items.size(), HDV_MAX_JOINTS) : 0;
  const double more = others != nullptr ? document::toNumber(others->scalar).value_or(0) : 0;
  return std::min<size_t>(rows->items.size() + static_cast<size_t>(std::clamp(more, 0.0, 16.0)), HDV_MAX_JOINTS);
}

/// Returns the device with the simplest wire format, address and calibration in the place of its own, in which there
/// are mistakes, so that the rest of the arm can be judged.
scene::Device withPlainBoard(scene::Device device, size_t joints) {
  std::string positions, torques;
  for (size_t i = 0; i < joints; ++i) {
    const std::string rest = fmt::format(R"("joint": {}, "at": {}, "type": "f32"}})", i + 1, 4 * i);
    positions += (i > 0 ? ", " : "") + (R"({"is": "position", )" + rest);
    torques += (i > 0 ? ", " : "") + (R"({"is": "torque", )" + rest);
  }
  std::erase_if(device.parameters, [](const scene::Value& value) { return value.id.starts_with("calibration."); });
  for (scene::Value& value : device.parameters)
    if (value.id == "usb.id")
      value.text = "1234:5678";
    else if (value.id == "wire")
      value.text = fmt::format(
          R"({{"rate": 1000, "input": {{"size": {0}, "fields": [{1}]}}, "output": {{"size": {0}, "fields": [{2}]}}}})",
          4 * joints, positions, torques);
  return device;
}

/// Makes the arm of a file with problems; nullptr if its geometry is among them. A module that was not tried because of
/// other problems may crash, so it is tried in a child process first.
std::unique_ptr<host::DeviceInstance> makeArm(const Node& root, const scene::Device& device,
                                              const document::Problems& known) {
  if (!kinematicsKnown(known)) return nullptr;
  std::vector<scene::Device> attempts{device};
  if (const size_t joints = jointsIn(root); !known.empty() && joints > 0)
    attempts.push_back(withPlainBoard(device, joints));
  for (const scene::Device& one : attempts)
    if (known.empty() || tryModule(one).error.empty())
      if (auto made = host::DeviceInstance::create(one, nullptr)) return std::move(*made);
  return nullptr;
}

/// Judges everything, with the arm that the file describes.
void checkWholeArm(const Node& root, const scene::Device& device, host::DeviceInstance& arm,
                   document::Problems& warnings) {
  const size_t joints = arm.kinematics().joint_count;
  warnOfLimits(root, device, arm, warnings);
  warnOfSafety(root, device, arm, warnings);
  restOutsideWorkspace(root, device, arm, warnings);
  poseBeyondStops(root, device, warnings);
  warnOfWire(root, device, joints, warnings);
  warnOfTravel(root, device, joints, &arm, warnings);
  warnOfMotors(root, device, joints, warnings);
  warnOfNoMount(root, device, arm, warnings);
  warnOfFarMount(root, device, arm, warnings);
  warnOfImplausibleFields(root, device, joints, &arm, warnings);
  warnOfImplausibleLimits(root, device, &arm, warnings);
  warnOfImplausibleArm(root, device, &arm, warnings);
}

/// Judges single values of a file with mistakes, without its arm.
void checkParts(const Node& root, const scene::Device& device, document::Problems& warnings) {
  const size_t joints = jointsIn(root);
  poseBeyondStops(root, device, warnings);
  if (joints > 0) {
    warnOfWire(root, device, joints, warnings);
    warnOfTravel(root, device, joints, nullptr, warnings);
    warnOfImplausibleFields(root, device, joints, nullptr, warnings);
  }
  warnOfMotors(root, device, joints, warnings);
  warnOfImplausibleLimits(root, device, nullptr, warnings);
  warnOfImplausibleArm(root, device, nullptr, warnings);
}

/// Returns the part of a file that is judged together with a key: a field of a report, and the lengths of an arm.
std::string partOf(const std::string& key) {
  const size_t fields = key.find(".fields["), end = fields == std::string::npos ? fields : key.find(']', fields);
  if (end != std::string::npos) return key.substr(0, end + 1);
  return isBelow(key, "parameters.arm.lengths") ? "parameters.arm.lengths" : key;
}

/// Returns true if a list of angles has a wrong number of rows, rows in the wrong order, or a number out of range,
/// while all of it are numbers. The unit of the others can be judged then.
bool hasAngles(const Node& root, const document::Problem& known) {
  const Node* list = isBelow(known.key, "parameters.arm.limits") ? find(root, {"parameters", "arm", "limits"})
                     : isBelow(known.key, "parameters.calibration.pose")
                         ? find(root, {"parameters", "calibration", "pose"})
                         : nullptr;
  if (list == nullptr || !list->isSequence()) return false;
  const auto number = [](const Node& item) { return item.isScalar() && document::toNumber(item.scalar); };
  return std::all_of(list->items.begin(), list->items.end(), [&number](const Node& item) {
    return item.isSequence() ? item.items.size() == 2 && std::all_of(item.items.begin(), item.items.end(), number)
                             : number(item);
  });
}

/// Removes warnings about a key that is wrong anyway, or about what is in it or around it.
void dropKnown(const Node& root, const document::Problems& known, document::Problems& warnings) {
  std::erase_if(warnings, [&root, &known](const document::Problem& warning) {
    return std::any_of(known.begin(), known.end(), [&root, &warning](const document::Problem& one) {
      if (warning.key == "parameters.arm.limits" || warning.key == "parameters.calibration.pose")
        if (hasAngles(root, one)) return false;
      if (one.key.ends_with(".type") && warning.key == one.key.substr(0, one.key.size() - 4) + "to")
        return false;  // which bytes a checksum covers does not depend on its type
      if (warning.key == "mount" && (isBelow(one.key, "parameters.calibration") || isBelow(one.key, "parameters.arm")))
        return true;  // where the tip rests follows from these
      const std::string part = partOf(one.key);
      return !part.empty() && part != "parameters" && (isBelow(warning.key, part) || isBelow(part, warning.key));
    });
  });
}

}  // namespace

document::Problems warnOfDevice(const std::filesystem::path& file, host::Catalog& catalog,
                                const document::Problems& known) {
  document::Problems warnings, unread;
  const auto device = known.empty() ? scene::loadDevice(file, catalog).device : scene::deviceDraft(file, catalog);
  auto root = device ? document::readFileOn(file, unread) : std::nullopt;
  if (!root) return warnings;
  if (!known.empty()) root = withCorrectedWire(withCorrectedParameters(std::move(*root), *device), *device);
  countsWithoutScale(*root, file.string(), warnings);
  massesOfAnotherArm(*root, file.string(), warnings);
  massesAtTheEnds(*root, file.string(), warnings);
  warnOfUnits(*root, file.string(), warnings);
  warnOfTable(*root, file.string(), warnings);
  if (const auto arm = makeArm(*root, *device, known))
    checkWholeArm(*root, *device, *arm, warnings);
  else
    checkParts(*root, *device, warnings);
  warnOfWeights(*root, file.string(), warnings);
  dropKnown(*root, known, warnings);
  document::sortByPlace(warnings);
  return warnings;
}

}  // namespace hapticd::diagnostics
