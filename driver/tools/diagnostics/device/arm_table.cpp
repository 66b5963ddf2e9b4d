// SPDX-License-Identifier: MIT
#include "diagnostics/device/arm_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;
using Row = std::array<double, 4>;

double numberOf(const Node& item) {
  return document::toNumber(item.scalar).value_or(0);
}

/// Returns the rows of arm.dh with theta and alpha in rad, also if they were given in degrees; nothing if the table is
/// not of numbers in rows of four.
std::vector<Row> tableOf(const Node* dh) {
  std::vector<Row> rows;
  if (dh == nullptr || !dh->isSequence()) return rows;
  for (const Node& item : dh->items) {
    if (!item.isSequence() || item.items.size() != 4) return {};
    Row row{};
    for (size_t i = 0; i < row.size(); ++i) {
      if (!document::toNumber(item.items[i].scalar)) return {};
      row[i] = numberOf(item.items[i]);
      if (i % 2 == 1 && std::abs(row[i]) > 2 * M_PI) row[i] *= M_PI / 180;
    }
    rows.push_back(row);
  }
  return rows;
}

/// Returns true if no link has a length a, but some have one if the columns are read as theta, d, a, alpha.
bool seemsTurnedRound(const std::vector<Row>& rows) {
  const auto has = [&rows](size_t column) {
    return std::any_of(rows.begin(), rows.end(), [column](const Row& row) { return std::abs(row[column]) > 1e-6; });
  };
  return !has(0) && has(2);
}

/// Warns of two joints with the same axis. One of these joints would be useless, so the columns were probably written
/// in another order.
void sameAxis(const Node* dh, const std::string& file, document::Problems& warnings) {
  constexpr double kLength = 1e-6, kAngle = 1e-3;  // [m]; [rad]
  const std::vector<Row> rows = tableOf(dh);
  for (size_t i = 0; i + 1 < rows.size(); ++i) {
    const Row& row = rows[i];
    if (std::abs(row[0]) > kLength || std::abs(std::sin(row[1])) > kAngle) continue;
    std::string what = fmt::format(
        "joints {} and {} turn about the same axis, because a and alpha are 0 between them, so one of them is useless; "
        "the columns are a, alpha, d, theta",
        i + 1, i + 2);
    if (seemsTurnedRound(rows))
      what +=
          fmt::format(", and this table seems to have theta, d, a, alpha: expected [{:g}, {:.7g}, {:g}, {:.7g}] here",
                      row[2], row[3], row[1], row[0]);
    return document::report(warnings, file, dh->items[i].line, dh->items[i].column,
                            fmt::format("parameters.arm.dh[{}]", i), what);
  }
}

/// Warns of a length that is exactly a quarter or half of a turn, because it is an angle in a wrong column.
void angleAsLength(const Node* dh, const std::string& file, document::Problems& warnings) {
  constexpr double kExact = 1e-3;
  const std::vector<Row> rows = tableOf(dh);
  for (size_t i = 0; i < rows.size(); ++i)
    for (const size_t column : {size_t{0}, size_t{2}}) {
      const double length = std::abs(rows[i][column]);
      if (std::abs(length - M_PI / 2) > kExact && std::abs(length - M_PI) > kExact) continue;
      const Node& at = dh->items[i].items[column];
      document::report(warnings, file, at.line, at.column, fmt::format("parameters.arm.dh[{}][{}]", i, column),
                       fmt::format("{:g} m as {} of joint {} is {} of a turn in rad, so it seems to be an angle; the "
                                   "columns are a, alpha, d, theta",
                                   rows[i][column], column == 0 ? "a" : "d", i + 1, length > 2 ? "half" : "a quarter"));
    }
}

/// A key of the arm that mechanisms of some kinds ignore.
struct Idle {
  const char* kind;
  std::vector<const char*> keys;
};

/// Warns of keys that the kind of the arm has no use for, such as those left over from a copy.
void idleKeys(const Node& root, const std::string& file, document::Problems& warnings) {
  const Node *arm = find(root, {"parameters", "arm"}), *kind = find(root, {"parameters", "arm", "kind"});
  if (arm == nullptr || !arm->isMap() || kind == nullptr) return;
  const std::vector<const char*> of_phantom{"dh",     "others",           "tool_position", "centers",
                                            "angles", "base_orientation", "base_position"};
  const Idle all[] = {{"phantom", of_phantom},
                      {"premium15", of_phantom},
                      {"delta", {"dh", "others", "tool_position", "centers"}},
                      {"chain", {"lengths", "angles"}}};
  for (const Idle& of : all)
    for (const char* key : of.keys) {
      const Node* given = kind->scalar == of.kind ? arm->find(key) : nullptr;
      if (given == nullptr || (given->isSequence() && given->items.empty())) continue;
      document::report(
          warnings, file, given->line, given->column, std::string("parameters.arm.") + key,
          fmt::format("this key is ignored, because a {} has no {}; remove it, or set another arm.kind", of.kind, key));
    }
}

/// Returns the largest number of a list.
double most(const Node* list) {
  double found = 0;
  if (list == nullptr || !list->isSequence()) return found;
  for (const Node& item : list->items) found = std::max(found, numberOf(item));
  return found;
}

void tooMuch(const Node* list, const char* key, double limit, const char* what, const char* unit, const char* smaller,
             const std::string& file, document::Problems& warnings) {
  const double given = most(list);
  if (given <= limit ||
      std::any_of(warnings.begin(), warnings.end(), [key](const auto& one) { return one.key == key; }))
    return;
  document::report(warnings, file, list->line, list->column, key,
                   fmt::format("{0:g} {1} is {2} of an arm that a hand moves; "
                               "the values must be in {1}: {0:g} {3} is {4:g} {1}",
                               given, unit, what, smaller, given / 1000));
}

}  // namespace

void warnOfTable(const Node& root, const std::string& file, document::Problems& warnings) {
  const Node *dh = find(root, {"parameters", "arm", "dh"}), *kind = find(root, {"parameters", "arm", "kind"});
  if (kind != nullptr && kind->scalar == "chain") {
    sameAxis(dh, file, warnings);
    angleAsLength(dh, file, warnings);
  }
  idleKeys(root, file, warnings);
  if (const auto stuck = stuckJoint(root, file)) warnings.push_back(*stuck);
}

void warnOfWeights(const Node& root, const std::string& file, document::Problems& warnings) {
  constexpr double kHeavy = 20, kStrong = 200;  // [kg]; [N m] of a joint
  tooMuch(find(root, {"parameters", "arm", "masses"}), "parameters.arm.masses", kHeavy, "too heavy for a link", "kg",
          "g", file, warnings);
  tooMuch(find(root, {"parameters", "arm", "max_torque"}), "parameters.arm.max_torque", kStrong,
          "more than the motor of a joint", "N m", "N mm", file, warnings);
}

std::optional<document::Problem> stuckJoint(const Node& root, const std::string& file) {
  constexpr double kRoom = 0.01;  // [rad]
  const Node* limits = find(root, {"parameters", "arm", "limits"});
  for (size_t i = 0; limits != nullptr && limits->isSequence() && i < limits->items.size(); ++i) {
    const Node& row = limits->items[i];
    if (!row.isSequence() || row.items.size() != 2) continue;
    const auto low = document::toNumber(row.items[0].scalar), high = document::toNumber(row.items[1].scalar);
    if (!low || !high || *high < *low || *high - *low > kRoom) continue;
    return document::Problem{
        {file, row.line, row.column},
        fmt::format("parameters.arm.limits[{}]", i),
        fmt::format("from {:g} to {:g} rad joint {} cannot move, so the tip cannot be led to where "
                    "a hand wants it; expected the stops of the joint, the smaller number first",
                    *low, *high, i + 1)};
  }
  return std::nullopt;
}

}  // namespace hapticd::diagnostics
