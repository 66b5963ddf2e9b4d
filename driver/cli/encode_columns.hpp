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
  std::vector<std::string> names;  ///< as encodeRow() knows them, one for each number of a row
  std::vector<size_t> from;        ///< the column of each; of the table
  std::vector<size_t> tip;         ///< columns x, y and z, whose joints come after those; empty: none

  /// The numbers of one row. @param joints where the arm is; the next row goes on from there
  Result<std::vector<double>> row(const double* values, const host::DeviceInstance& arm,
                                  std::vector<double>& joints) const;
};

/// [main] From the names of a table: those of `known` as they are, q1 as position1 where the arm speaks, or else the
/// joints of the tip x,y,z; tau1 as torque1 where it is spoken to. The rest of what `device kinematics` writes is left
/// out. The error names a column that is neither.
/// @param known columns of the report @param to_arm an order; otherwise as the arm would send it
Result<EncodeColumns> encodeColumns(const std::vector<std::string>& names, const std::vector<std::string>& known,
                                    size_t joints, bool to_arm);

}  // namespace hapticd::cli
