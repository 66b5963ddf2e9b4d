// SPDX-License-Identifier: MIT
/// Numbers that do not fit into the field that carries them.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "codec/wire.hpp"

namespace hapticd::capture {

/// Numbers of many rows that had to be sent as other numbers, column by column.
class Saturation {
 public:
  /// @param motors [N m] greatest torques of the joints; empty: not known
  explicit Saturation(std::vector<double> motors = {}) : motors_(std::move(motors)) {}

  /// [main] One row, as encodeRow() takes it. @param to_arm a command; otherwise as the arm would send it
  void look(const codec::Wire& wire, bool to_arm, const std::vector<std::string>& columns, const double* values,
            int line);

  /// [main] One sentence for each such column, in the order in which they began: "line 5: torque1: 0.7 is beyond what
  /// its field can carry, -0.5 to 0.5; sent as 0.5; so are 12 further rows".
  std::vector<std::string> told() const;

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
