// SPDX-License-Identifier: MIT
/// The columns of `device kinematics` as those of a report, for `device encode`.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "host/device_instance.hpp"

namespace hapticd::cli {

/// Which of a table's columns become numbers of a report, and how.
struct EncodeColumns {
  std::vector<std::string> names;  ///< one per number of a row, in the names that encodeRow() knows
  std::vector<size_t> from;        ///< the column of the table for each of them
  std::vector<size_t> tip;         ///< columns x, y and z; their joints come after those; empty: there are none

  /// The numbers of one row. @param joints where the arm is, from which the next row continues
  Result<std::vector<double>> row(const double* values, const host::DeviceInstance& arm,
                                  std::vector<double>& joints) const;
};

/// [main] From the names of a table: those of `known` as they are, q1 as position1 where the arm speaks, or else the
/// joints of the tip x,y,z; tau1 as torque1 where it is spoken to. The rest of what `device kinematics` writes is left
/// out. The error names any other column.
/// @param known columns of the report @param to_arm an order; otherwise as the arm would send it
Result<EncodeColumns> encodeColumns(const std::vector<std::string>& names, const std::vector<std::string>& known,
                                    size_t joints, bool to_arm);

}  // namespace hapticd::cli
