// SPDX-License-Identifier: MIT
#include "capture/saturation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

namespace hapticd::capture {
namespace {

using codec::Field;
using codec::Role;

/// The field of a joint that a column names; nullptr: none, as buttons and counters have none of their own.
const Field* fieldOf(const codec::Report& report, const std::string& column) {
  static constexpr std::pair<const char*, Role> kNames[] = {{"position", Role::kPosition},
                                                            {"velocity", Role::kVelocity},
                                                            {"torque", Role::kTorque},
                                                            {"reference", Role::kReference}};
  for (const Field& field : report.fields)
    for (const auto& [name, role] : kNames)
      if (field.role == role && column == name + std::to_string(field.index + 1)) return &field;
  return nullptr;
}

/// Least and greatest SI value.
std::pair<double, double> rangeOf(const Field& field) {
  const double a = field.least * field.scale + field.offset, b = field.most * field.scale + field.offset;
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

std::vector<std::string> saturated(const codec::Wire& wire, bool to_arm, const std::vector<std::string>& columns,
                                   const double* values) {
  std::vector<std::string> found;
  for (size_t i = 0; i < columns.size(); ++i) {
    const Field* field = fieldOf(to_arm ? wire.output : wire.input, columns[i]);
    if (field == nullptr) continue;
    const auto [least, most] = rangeOf(*field);
    const double half = std::abs(field->scale) / 2;  // what rounding takes away is no loss
    if (values[i] >= least - half && values[i] <= most + half) continue;
    char text[200];
    std::snprintf(text, sizeof text, "%s: %g is beyond what its field can carry, %g to %g; sent as %g",
                  columns[i].c_str(), values[i], least, most, std::clamp(values[i], least, most));
    found.emplace_back(text);
  }
  return found;
}

}  // namespace hapticd::capture
