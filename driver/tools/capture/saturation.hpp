// SPDX-License-Identifier: MIT
/// Finds numbers that are too large or too small for their field in a report.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "codec/wire.hpp"

namespace hapticd::capture {

/// Collects, for each column, the numbers that did not fit into the field, so that other numbers were sent in their
/// place.
class Saturation {
 public:
  /// @param motors [N m] greatest torques of the joints; empty if unknown
  explicit Saturation(std::vector<double> motors = {}) : motors_(std::move(motors)) {}

  /// [main] Examines one row, in the form that encodeRow() takes. @param to_arm true for a command to the arm; false
  /// for a report from it
  void add(const codec::Wire& wire, bool to_arm, const std::vector<std::string>& columns, const double* values,
           int line);

  /// [main] Returns one sentence for each column with such numbers, in the order of their first lines: "line 5:
  /// torque1: 0.7 is beyond what its field can carry, -0.5 to 0.5; sent as 0.5; so are 12 further rows".
  std::vector<std::string> findings() const;

 private:
  struct Column {
    std::string name, first;
    size_t further = 0;
  };
  void keep(const std::string& column, const std::string& sentence);
  std::vector<double> motors_;
  std::vector<Column> columns_;
};

}  // namespace hapticd::capture
