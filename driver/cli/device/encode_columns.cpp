// SPDX-License-Identifier: MIT
#include "cli/device/encode_columns.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace hapticd::cli {
namespace {

bool among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns the number in a name such as "q3" (3 for the word "q"), or 0 if it is not such a name.
size_t numberAfter(const std::string& name, const std::string& word) {
  const std::string digits = name.rfind(word, 0) == 0 ? name.substr(word.size()) : "";
  if (digits.empty() || digits.size() > 2 || digits.find_first_not_of("0123456789") != std::string::npos) return 0;
  return std::stoul(digits);
}

/// Returns true for a column that `device kinematics` reads or writes.
bool ofKinematics(const std::string& name, size_t joints) {
  static const std::vector<std::string> kAlone = {"x",  "y",  "z",  "qw", "qx", "qy", "qz",
                                                  "fx", "fy", "fz", "tx", "ty", "tz"};
  if (among(kAlone, name)) return true;
  for (const char* word : {"q", "gravity", "tau", "J1_", "J2_", "J3_", "J4_", "J5_", "J6_"})
    if (const size_t number = numberAfter(name, word); number > 0 && number <= joints) return true;
  return false;
}

std::string inOneLine(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

/// Returns the columns x, y and z of a table; empty if one of them is missing.
std::vector<size_t> tipIn(const std::vector<std::string>& names) {
  std::vector<size_t> tip;
  for (const char* axis : {"x", "y", "z"})
    if (const auto at = std::find(names.begin(), names.end(), axis); at != names.end())
      tip.push_back(static_cast<size_t>(at - names.begin()));
  return tip.size() == 3 ? tip : std::vector<size_t>();
}

}  // namespace

Result<EncodeColumns> encodeColumns(const std::vector<std::string>& names, const std::vector<std::string>& known,
                                    size_t joints, bool to_arm) {
  EncodeColumns columns;
  bool poses = false;  // some columns are those of `device kinematics`, which are left out
  for (size_t i = 0; i < names.size(); ++i) {
    const size_t number = numberAfter(names[i], to_arm ? "tau" : "q");
    const std::string meant = (to_arm ? "torque" : "position") + std::to_string(number);
    const bool own = among(known, names[i]), alias = number > 0 && number <= joints && among(known, meant);
    if (!own && !alias && !ofKinematics(names[i], joints))
      return Error{"its first line has \"" + names[i].substr(0, 40) +
                   "\", which is neither a number nor a column of the report; expected some of these columns: " +
                   inOneLine(known)};
    poses |= !own && !alias;
    if (own || alias) columns.names.push_back(own ? names[i] : meant), columns.from.push_back(i);
  }
  for (size_t i = 0; i < columns.names.size(); ++i)
    if (std::find(columns.names.begin(), columns.names.begin() + static_cast<long>(i), columns.names[i]) !=
        columns.names.begin() + static_cast<long>(i))
      return Error{"its first line has " + columns.names[i] + " twice; expected each joint once"};
  const bool placed = std::any_of(columns.names.begin(), columns.names.end(),
                                  [](const std::string& name) { return name.rfind("position", 0) == 0; });
  if (!to_arm && !placed) columns.tip = tipIn(names);
  for (size_t i = 1; !columns.tip.empty() && i <= joints; ++i) columns.names.push_back("position" + std::to_string(i));
  if (!poses || !columns.names.empty()) return columns;
  return Error{to_arm ? "it is a table of `device kinematics` without torques (tau1, ...)\n  fix: give fx,fy,fz in the "
                        "CSV file for `device kinematics`, or use --from-arm to encode the positions"
                      : "it has neither joints (q1, ...) nor the whole tip (x, y and z)"};
}

Result<std::vector<double>> EncodeColumns::row(const double* values, const host::DeviceInstance& arm,
                                               std::vector<double>& joints) const {
  std::vector<double> numbers;
  for (const size_t column : from) numbers.push_back(values[column]);
  if (tip.empty()) return numbers;
  const std::array<double, 3> place = {values[tip[0]], values[tip[1]], values[tip[2]]};
  if (arm.kinematics().inverse(arm.handle(), place.data(), joints.data()) < 0) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "the tip [%g, %g, %g] is out of the arm's reach; the tip must be in m, in the device frame", place[0],
                  place[1], place[2]);
    return Error{text};
  }
  numbers.insert(numbers.end(), joints.begin(), joints.begin() + arm.kinematics().joint_count);
  return numbers;
}

}  // namespace hapticd::cli
