// SPDX-License-Identifier: MIT
#include "diagnostics/device/travel_warnings.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "diagnostics/device/device_wire.hpp"
#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {
namespace {

using codec::Field;
using codec::Role;
using document::Node;

/// A range, from least to greatest.
struct PositionRange {
  double low = 0, high = 0;
  double length() const { return high - low; }
};

/// Returns the range that a field can express; nothing for a field that continues past its end.
std::optional<PositionRange> sayable(const Field& field) {
  if (field.role != Role::kPosition || field.wraps || field.type == codec::Type::kFloat) return std::nullopt;
  const auto [least, most] = codec::rangeOf(field.type, field.bits);
  const double a = least * field.scale + field.offset, b = most * field.scale + field.offset;
  return PositionRange{std::min(a, b), std::max(a, b)};
}

/// Returns a text if a position that wraps does so within the travel of its joint, in steps finer than an encoder has;
/// else "".
std::string wrapsTooOften(const Field& field, const PositionRange& stops) {
  constexpr double kFinest = 2.5e-7;  // [rad] 25 million counts of a joint turn
  if (field.role != Role::kPosition || !field.wraps || field.scale == 0 || std::abs(field.scale) >= kFinest) return "";
  const double around = std::ldexp(std::abs(field.scale), static_cast<int>(field.bits));
  if (around >= stops.length()) return "";
  return fmt::format(
      "one count of joint {} is {:.3g} rad, {:.3g} counts per turn of the joint, and its {} bits would wrap within "
      "arm.limits; expected 2 pi / (counts per motor turn * motor turns per joint turn)",
      field.index + 1, std::abs(field.scale), 2 * M_PI / std::abs(field.scale), field.bits);
}

std::vector<double> limitsOf(const scene::Device& device) {
  const scene::Value* limits = givenIn(device.parameters, "arm.limits");
  return limits != nullptr ? limits->numbers : std::vector<double>();
}

/// Returns true if a joint can have these stops. Others have a warning of their own, and are no measure of a field.
bool areStops(const PositionRange& stops) {
  return std::max(std::abs(stops.low), std::abs(stops.high)) <= 2 * M_PI;
}

/// Returns true if the zero is where the arm was held during calibration, so that only the length of a range is known.
bool zeroedByPose(const scene::Device& device) {
  return numberIn(device.parameters, "calibration.method") > 1;
}

/// Returns a text if a field would express the whole range between the stops with the other sign of its offset.
std::string offsetTurnedRound(const Field& field, const PositionRange& said, const PositionRange& stops) {
  const double room = 0.02 * stops.length();
  const PositionRange other{said.low - 2 * field.offset, said.high - 2 * field.offset};
  const auto covers = [&](const PositionRange& range) {
    return range.low <= stops.low + room && range.high >= stops.high - room;
  };
  if (field.offset == 0 || covers(said) || !covers(other)) return "";
  return fmt::format(
      "has the wrong sign: this field covers {:.4g} to {:.4g} rad, "
      "and arm.limits of joint {} go from {:.4g} to {:.4g}; "
      "with the other sign it covers {:.4g} to {:.4g} rad: expected ",
      said.low, said.high, field.index + 1, stops.low, stops.high, other.low, other.high);
}

/// Returns a text if a field cannot express the whole range between the stops, or "".
std::string tooShort(const Field& field, const PositionRange& said, const PositionRange& stops, bool placed) {
  const double room = 0.02 * stops.length();  // stops are not measured more accurately
  const bool covers =
      placed ? said.low <= stops.low + room && said.high >= stops.high - room : said.length() >= stops.length() - room;
  if (covers || !(stops.length() > 0)) return "";
  const double times = placed ? std::max(std::abs(stops.low), std::abs(stops.high)) /
                                    std::max({std::abs(said.low), std::abs(said.high), 1e-300})
                              : stops.length() / said.length();
  return fmt::format(
      "this field covers only {:.4g} to {:.4g} rad, but arm.limits of joint {} go from {:.4g} to {:.4g}; expected {}a "
      "wider type, an offset, or wraps: true if the counter continues past its end",
      said.low, said.high, field.index + 1, stops.low, stops.high,
      times > 1.05 ? fmt::format("a scale that is {:.3g} times as large, ", times) : std::string());
}

/// Adds a warning at the offset of a field, with the number of the other sign. Returns false if it has none.
bool tellOffset(const Node& field, size_t index, const scene::Device& device, const std::string& what,
                document::Problems& warnings) {
  for (const char* key : {"offset", "offset_degrees"})
    if (const Node* offset = field.find(key)) {
      const double given = document::toNumber(offset->scalar).value_or(0);
      document::report(warnings, device.file.string(), offset->line, offset->column,
                       fmt::format("parameters.wire.input.fields[{}].{}", index, key),
                       what + fmt::format("{}: {:g}", key, -given));
      return true;
    }
  return false;
}

/// Returns the box around all places of the tip, with each joint in three positions.
Eigen::AlignedBox3d placesOf(const host::DeviceInstance& arm, const std::vector<PositionRange>& ways) {
  Eigen::AlignedBox3d box;
  size_t count = 1;
  for (size_t i = 0; i < ways.size(); ++i) count *= 3;
  for (size_t pose = 0; pose < count; ++pose) {
    std::array<double, HDV_MAX_JOINTS> q{};
    for (size_t i = 0, left = pose; i < ways.size(); ++i, left /= 3)
      q[i] = ways[i].low + ways[i].length() * 0.5 * static_cast<double>(left % 3);
    Eigen::Vector3d tip = Eigen::Vector3d::Zero();
    std::array<double, 4> turn{};
    if (arm.kinematics().forward(arm.handle(), q.data(), tip.data(), turn.data()) >= 0 && tip.allFinite())
      box.extend(tip);
  }
  return box;
}

/// [m] Returns the diagonal of that box.
double extentOf(const host::DeviceInstance& arm, const std::vector<PositionRange>& ways) {
  const Eigen::AlignedBox3d box = placesOf(arm, ways);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// Warns of a workspace that the arm can never leave, because millimetres were meant.
void workspaceBeyondReach(const Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                          document::Problems& warnings) {
  constexpr size_t kMostJoints = 6;  // three positions of each of six joints are 729 poses
  constexpr double kTimes = 3;
  const Node* given = find(root, {"limits", "workspace"});
  const size_t joints = arm.kinematics().joint_count;
  if (given == nullptr || device.limits.workspace <= 0 || joints > kMostJoints) return;
  const std::vector<double> limits = limitsOf(device);
  std::vector<PositionRange> ways(joints, PositionRange{-M_PI, M_PI});
  for (size_t i = 0; i < joints && limits.size() == 2 * joints; ++i) ways[i] = {limits[2 * i], limits[2 * i + 1]};
  const Eigen::AlignedBox3d places = placesOf(arm, ways);
  if (places.isEmpty()) return;
  const double reach = places.min().cwiseAbs().cwiseMax(places.max().cwiseAbs()).norm();
  if (device.limits.workspace <= kTimes * reach) return;
  document::report(
      warnings, device.file.string(), given->line, given->column, "limits.workspace",
      fmt::format("{:g} m about the origin bounds nothing, because the tip is never farther from it than {:.2g} m; the "
                  "value must be in m: {:g} mm is {:g} m",
                  device.limits.workspace, reach, device.limits.workspace, device.limits.workspace / 1000));
}

/// Warns if the positions can express only a small part of limits.workspace. Without stops in the file, only the
/// workspace shows how far the arm should move.
void narrowWorkspace(const Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                     const codec::Wire& wire, document::Problems& warnings) {
  constexpr size_t kMostJoints = 6;  // three positions of each of six joints are 729 poses
  constexpr double kSmall = 0.35;    // share of the workspace's width
  const Node* given = find(root, {"limits", "workspace"});
  const size_t joints = arm.kinematics().joint_count;
  if (given == nullptr || device.limits.workspace <= 0 || joints > kMostJoints) return;
  std::vector<PositionRange> ways(joints, PositionRange{});
  for (const Field& field : wire.input.fields)
    if (field.role == Role::kPosition) {
      const auto said = sayable(field);
      if (!said || field.index >= joints) return;
      ways[field.index] = {std::max(said->low, -M_PI), std::min(said->high, M_PI)};
    }
  const double extent = extentOf(arm, ways),
               whole = extentOf(arm, std::vector<PositionRange>(joints, PositionRange{-M_PI, M_PI}));
  if (extent >= kSmall * 2 * device.limits.workspace || extent >= 0.5 * whole) return;
  document::report(warnings, device.file.string(), given->line, given->column, "limits.workspace",
                   fmt::format("{:g} m is more than the tip can move: the positions in wire.input reach only {:.3g} m; "
                               "expected a larger scale (rad per count) in wire.input, or a smaller workspace",
                               device.limits.workspace, extent));
}

}  // namespace

void warnOfTravel(const Node& root, const scene::Device& device, size_t joints, const host::DeviceInstance* arm,
                  document::Problems& warnings) {
  if (arm != nullptr) workspaceBeyondReach(root, device, *arm, warnings);
  const auto wire = wireDraftOf(device, joints);
  const Node* fields = find(root, {"parameters", "wire", "input", "fields"});
  if (!wire || fields == nullptr) return;
  const std::vector<double> limits = limitsOf(device);
  if (limits.size() != 2 * joints) {
    if (arm != nullptr && wireOf(device, joints)) narrowWorkspace(root, device, *arm, *wire, warnings);
    return;
  }
  for (size_t i = 0; i < wire->input.fields.size() && i < fields->items.size(); ++i) {
    const Field& field = wire->input.fields[i];
    const auto said = sayable(field);
    if (field.role != Role::kPosition || field.index >= joints) continue;
    const auto [low, high] = std::minmax(limits[2u * field.index], limits[2u * field.index + 1]);
    const PositionRange stops{low,
                              high};  // in order, also where the file has them in the other one: reported elsewhere
    if (!areStops(stops)) continue;
    if (const std::string turned = said && !zeroedByPose(device) ? offsetTurnedRound(field, *said, stops) : "";
        !turned.empty() && tellOffset(fields->items[i], i, device, turned, warnings))
      continue;
    const std::string wrong = said ? tooShort(field, *said, stops, !zeroedByPose(device)) : wrapsTooOften(field, stops);
    if (wrong.empty()) continue;
    const Node* scale = fields->items[i].find("scale");
    const Node& at = scale != nullptr ? *scale : fields->items[i];
    document::report(warnings, device.file.string(), at.line, at.column,
                     fmt::format("parameters.wire.input.fields[{}].scale", i), wrong);
  }
}

}  // namespace hapticd::diagnostics
