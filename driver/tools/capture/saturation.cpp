// SPDX-License-Identifier: MIT
#include "capture/saturation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace hapticd::capture {
namespace {

using codec::Field;
using codec::Role;

/// Returns the field of a joint that a column names; nullptr if there is none, as for buttons and counters.
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

/// Returns the least and greatest value that a field can carry, in SI units.
std::pair<double, double> rangeOf(const Field& field) {
  const double a = field.least * field.scale + field.offset, b = field.most * field.scale + field.offset;
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

void Saturation::add(const codec::Wire& wire, bool to_arm, const std::vector<std::string>& columns,
                     const double* values, int line) {
  for (size_t i = 0; i < columns.size(); ++i) {
    const Field* field = fieldOf(to_arm ? wire.output : wire.input, columns[i]);
    if (field == nullptr || (field->wraps && std::isfinite(values[i]))) continue;
    const auto [least, most] = rangeOf(*field);
    const double half = std::abs(field->scale) / 2;  // a change by rounding does not count
    const double motor =
        to_arm && field->role == Role::kTorque && field->index < motors_.size() ? motors_[field->index] : 0;
    char text[240];
    if (values[i] >= least - half && values[i] <= most + half) {
      if (!(motor > 0) || std::abs(values[i]) <= motor + half) continue;
      std::snprintf(text, sizeof text,
                    "line %d: %s: %g N m is above arm.max_torque of joint %d, %g: a run never asks for it", line,
                    columns[i].c_str(), values[i], field->index + 1, motor);
      keep(columns[i], text);
      continue;
    }
    std::snprintf(text, sizeof text, "line %d: %s: %g is beyond what its field can carry, %g to %g; sent as %g", line,
                  columns[i].c_str(), values[i], least, most, std::clamp(values[i], least, most));
    keep(columns[i], text);
  }
}

void Saturation::keep(const std::string& column, const std::string& sentence) {
  const auto known =
      std::find_if(columns_.begin(), columns_.end(), [&](const Column& other) { return other.name == column; });
  if (known == columns_.end())
    columns_.push_back({column, sentence});
  else
    ++known->further;
}

std::vector<std::string> Saturation::findings() const {
  std::vector<std::string> all;
  for (const Column& column : columns_) {
    all.push_back(column.first);
    if (column.further > 0)
      all.back() +=
          "; so " + std::string(column.further == 1 ? "is 1 further row"
                                                    : "are " + std::to_string(column.further) + " further rows");
  }
  return all;
}

}  // namespace hapticd::capture
