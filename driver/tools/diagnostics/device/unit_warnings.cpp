// SPDX-License-Identifier: MIT
#include "diagnostics/device/unit_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnostics/reading/given_values.hpp"
#include "diagnostics/reading/number_slips.hpp"
#include "document/correction.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// Returns the angles of more than a whole turn, each once, the largest first. Those beyond the parameters' range have
/// an error.
std::vector<double> beyondATurn(const Node* list) {
  constexpr double kMost = 100;  // [rad]
  std::vector<double> angles;
  for (const double angle : numbersIn(list)) {
    const bool known = std::find(angles.begin(), angles.end(), angle) != angles.end();
    if (!known && std::abs(angle) > 2 * M_PI && std::abs(angle) <= kMost) angles.push_back(angle);
  }
  const auto largest = std::max_element(angles.begin(), angles.end(), [](double a, double b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) < std::abs(b) : a < b;
  });
  if (largest != angles.end()) std::rotate(angles.begin(), largest, largest + 1);
  return angles;
}

void warnOfAngles(const Node* list, const char* key, const std::string& file, document::Problems& warnings) {
  const std::vector<double> angles = beyondATurn(list);
  if (angles.empty()) return;
  std::string others;
  for (size_t i = 1; i < angles.size(); ++i)
    others += fmt::format("{}{:g}", i == 1 ? ", and so are " : ", ", angles[i]);
  document::report(
      warnings, file, list->line, list->column, key,
      fmt::format("{0:g} rad is more than a whole turn{1}; the value{2} must be in rad: {0:g} degrees is {3:.4g} rad",
                  angles[0], others, others.empty() ? "" : "s", angles[0] * M_PI / 180));
}

/// Warns of angles in degrees. Below 10, they are within the range of the parameter, which ends at 10 rad; but the
/// table of a real arm has no whole numbers of radians, and no angles of more than half a turn.
void twistInDegrees(const Node* rows, const std::string& file, document::Problems& warnings) {
  if (rows == nullptr || !rows->isSequence()) return;
  for (size_t row = 0; row < rows->items.size(); ++row) {
    const Node& link = rows->items[row];
    for (const size_t column : {size_t{1}, size_t{3}}) {
      if (column >= link.items.size()) continue;
      const double angle = document::toNumber(link.items[column].scalar).value_or(0);
      const bool whole = angle != 0 && angle == std::round(angle);
      if (!whole && std::abs(angle) <= M_PI + 0.01) continue;
      document::report(
          warnings, file, link.items[column].line, link.items[column].column,
          fmt::format("parameters.arm.dh[{}][{}]", row, column),
          fmt::format("{:g} rad is {:.4g} degrees, which is unusual for {} of joint {}; the value must be in rad: {:g} "
                      "degrees is {:.4g} rad",
                      angle, angle * 180 / M_PI, column == 1 ? "alpha" : "theta", row + 1, angle, angle * M_PI / 180));
    }
  }
}

/// Warns of a link that is too long, because its length is not in metres or its decimal point is wrong.
void linkTooLong(const Node* lengths, const std::string& file, document::Problems& warnings) {
  constexpr double kLong = 2;  // [m] longer than a person's arm, and than any haptic arm
  const double most = largest(numbersIn(lengths));
  if (most <= kLong) return;
  document::report(
      warnings, file, lengths->line, lengths->column, "parameters.arm.lengths",
      fmt::format(
          "{:g} m is too long for an arm that a hand moves; the value must be in m: is the decimal point wrong, "
          "or was {:g} m meant?",
          most, most / 10));
}

/// Warns of a link of a chain that is too long. The lengths are in two columns of its table.
void chainTooLong(const Node* rows, const std::string& file, document::Problems& warnings) {
  constexpr double kLong = 2;  // [m] as for other links
  if (rows == nullptr || !rows->isSequence()) return;
  for (size_t row = 0; row < rows->items.size(); ++row)
    for (const size_t column : {size_t{0}, size_t{2}}) {
      if (column >= rows->items[row].items.size()) continue;
      const Node& at = rows->items[row].items[column];
      const double length = std::abs(document::toNumber(at.scalar).value_or(0));
      if (length <= kLong) continue;
      document::report(
          warnings, file, at.line, at.column, fmt::format("parameters.arm.dh[{}][{}]", row, column),
          fmt::format("{:g} m as {} of joint {} is too long for an arm that a hand moves; the value must be in m: is "
                      "the decimal point wrong, or was {:g} m meant?",
                      length, column == 0 ? "a" : "d", row + 1, length / 10));
    }
}

/// Warns of lengths and masses such as [0,2, 0,18, 0], which have the right count by chance.
void commasInNumbers(const Node* list, const char* key, const std::string& file, document::Problems& warnings) {
  constexpr size_t kLeast = 2;
  if (list == nullptr) return;
  if (const std::string advice = document::suggestDecimals(*list, kLeast); !advice.empty())
    document::report(warnings, file, list->line, list->column, key, "zeros and whole numbers take turns" + advice);
}

/// Warns of a negative length: the direction of a link is given by its signs or angles, not by its length.
void lengthBelowZero(const Node* lengths, const std::string& file, document::Problems& warnings) {
  for (const double length : numbersIn(lengths))
    if (length < 0)
      return document::report(warnings, file, lengths->line, lengths->column, "parameters.arm.lengths",
                              fmt::format("{:g} m is below 0; expected 0 or more; to reverse a direction, change the "
                                          "signs of the positions and torques",
                                          length));
}

/// Returns the advice for an offset that is in counts.
std::string inCounts(double value, const Node& field) {
  for (const auto& [key, offset] : {std::pair{"scale", "offset"}, std::pair{"scale_degrees", "offset_degrees"}})
    if (const Node* scale = field.find(key))
      if (const double one = document::toNumber(scale->scalar).value_or(0); one != 0)
        return fmt::format("if it is in counts, multiply it by {}: {}: {:.6g}", key, offset, value * one);
  return "counts must be multiplied by scale";
}

/// Warns of an offset of more than a turn, which was meant in degrees or in counts.
void offsetBeyondATurn(const Node* fields, const std::string& file, document::Problems& warnings) {
  constexpr double kTwoTurns = 720;  // degrees
  if (fields == nullptr || !fields->isSequence()) return;
  for (size_t i = 0; i < fields->items.size(); ++i) {
    const Node *is = fields->items[i].find("is"), *offset = fields->items[i].find("offset");
    if (is == nullptr || is->scalar != "position" || offset == nullptr) continue;
    const double value = document::toNumber(offset->scalar).value_or(0);
    if (std::abs(value) <= 2 * M_PI) continue;
    document::report(
        warnings, file, offset->line, offset->column, fmt::format("parameters.wire.input.fields[{}].offset", i),
        fmt::format("{:g} rad is more than a whole turn; the value must be in rad (or m); ", value) +
            (std::abs(value) <= kTwoTurns ? fmt::format("if it is in degrees, write offset_degrees: {:g}", value)
                                          : inCounts(value, fields->items[i])));
  }
}

}  // namespace

bool hasLimitsBeyondATurn(const Node& root) {
  return !beyondATurn(find(root, {"parameters", "arm", "limits"})).empty();
}

void warnOfUnits(const Node& root, const std::string& file, document::Problems& warnings) {
  warnOfZeros(root, file, warnings);
  warnOfAngles(find(root, {"parameters", "arm", "limits"}), "parameters.arm.limits", file, warnings);
  warnOfAngles(find(root, {"parameters", "calibration", "pose"}), "parameters.calibration.pose", file, warnings);
  twistInDegrees(find(root, {"parameters", "arm", "dh"}), file, warnings);
  chainTooLong(find(root, {"parameters", "arm", "dh"}), file, warnings);
  linkTooLong(find(root, {"parameters", "arm", "lengths"}), file, warnings);
  commasInNumbers(find(root, {"parameters", "arm", "lengths"}), "parameters.arm.lengths", file, warnings);
  commasInNumbers(find(root, {"parameters", "arm", "masses"}), "parameters.arm.masses", file, warnings);
  lengthBelowZero(find(root, {"parameters", "arm", "lengths"}), file, warnings);
  offsetBeyondATurn(find(root, {"parameters", "wire", "input", "fields"}), file, warnings);
  warnOfMount(find(root, {"mount", "position"}), "mount.position", file, warnings);
  warnOfTurn(find(root, {"mount", "orientation"}), "mount.orientation", file, warnings);
  warnOfTurn(find(root, {"parameters", "arm", "base_orientation"}), "parameters.arm.base_orientation", file, warnings);
}

}  // namespace hapticd::diagnostics
