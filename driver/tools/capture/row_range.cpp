// SPDX-License-Identifier: MIT
#include "capture/row_range.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/short_number.hpp"

namespace hapticd::capture {
namespace {

using codec::Field;
using codec::Role;

std::string textOf(double value) {
  return withDigits(value, 10);
}

bool isWhole(double value) {
  return std::isfinite(value) && value == std::floor(value) && value >= 0;
}

/// Returns the largest number that every counter of this role in the report can hold. Two counters around a report hold
/// the same number.
double mostOf(const codec::Report& report, Role role) {
  double most = 4294967295.0;
  for (const Field& field : report.fields) {
    if (field.role != role) continue;
    const int digits = field.type == codec::Type::kNibble ? 4 : field.type == codec::Type::kNibbles ? 16 : field.bits;
    most = std::min(most, std::ldexp(1, digits) - 1);
    if (field.modulo != 0) most = std::min(most, static_cast<double>(field.modulo - 1));
  }
  return most;
}

std::string wrongButtons(const codec::Report& report, double value) {
  uint32_t mask = 0;
  std::string buttons;
  for (uint32_t button = 0; button < codec::kMaxButtons; ++button) {
    const bool there = std::any_of(report.fields.begin(), report.fields.end(), [button](const Field& field) {
      return field.role == Role::kButton && field.index == button;
    });
    if (!there) continue;
    mask |= uint32_t{1} << button;
    buttons += (buttons.empty() ? "" : ", ") + std::to_string(uint32_t{1} << button) + " for button " +
               std::to_string(button + 1);
  }
  if (isWhole(value) && value <= mask && (static_cast<uint32_t>(value) & ~mask) == 0) return "";
  return textOf(value) + ", expected 0 or a sum of these numbers: " + buttons + " (the report has no other buttons)";
}

std::optional<Role> roleOf(const std::string& column) {
  static constexpr std::pair<const char*, Role> kNames[] = {
      {"buttons", Role::kButton}, {"sequence", Role::kSequence},   {"starts", Role::kStarts},
      {"clock", Role::kTime},     {"fault", Role::kFault},         {"calibrated", Role::kCalibrated},
      {"enable", Role::kEnable},  {"calibrate", Role::kCalibrate}, {"follow", Role::kFollow}};
  for (const auto& [name, role] : kNames)
    if (column == name) return role;
  return std::nullopt;
}

}  // namespace

std::string beyondField(const codec::Wire& wire, bool to_arm, const std::string& column, double value) {
  const codec::Report& report = to_arm ? wire.output : wire.input;
  const auto role = roleOf(column);
  if (!role) return "";
  if (*role == Role::kButton) return wrongButtons(report, value);
  if (*role == Role::kTime)
    return std::isfinite(value) && value >= 0 ? "" : textOf(value) + " s, expected a time of 0 s or more";
  if (*role == Role::kSequence || *role == Role::kStarts) {
    const double most = mostOf(report, *role);
    return isWhole(value) && value <= most
               ? ""
               : textOf(value) + ", expected a whole number from 0 to " + textOf(most) + ", which its field can hold";
  }
  return value == 0 || value == 1 ? "" : textOf(value) + ", expected 0 (no) or 1 (yes)";
}

}  // namespace hapticd::capture
