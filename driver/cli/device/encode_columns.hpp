// SPDX-License-Identifier: MIT
/// Converts the columns of `device kinematics` to those of a report, for `device encode`.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "host/device_instance.hpp"

namespace hapticd::cli {

/// The columns of a table that become numbers of a report.
struct EncodeColumns {
  std::vector<std::string> names;  ///< name of each number of a row, as encodeRow() expects it
  /// from[i] is the column of the table for names[i]. It is shorter than `names` if the joints are computed from the
  /// tip: their names come last and have no entry here.
  std::vector<size_t> from;
  /// columns x, y and z of the tip; the joints that are computed from it come last in a row. Empty if not used
  std::vector<size_t> tip;

  /// Returns the numbers of one row. @param joints in: joints of the row before, at which inverse kinematics starts;
  /// out: joints of this row
  Result<std::vector<double>> row(const double* values, const host::DeviceInstance& arm,
                                  std::vector<double>& joints) const;
};

/// [main] Finds the columns to encode from the names in a table. Names in `known` are used as they are. In a command to
/// the arm, tau1 is torque1; in a report from it, q1 is position1, and without q1 the joints follow from the tip x,y,z.
/// Other columns of `device kinematics` are left out. Any other name is an error. @param known columns of the report
/// @param to_arm true for a command to the arm; false for a report from it
Result<EncodeColumns> encodeColumns(const std::vector<std::string>& names, const std::vector<std::string>& known,
                                    size_t joints, bool to_arm);

}  // namespace hapticd::cli
