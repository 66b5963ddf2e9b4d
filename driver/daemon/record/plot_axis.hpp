// SPDX-License-Identifier: MIT
/// An axis of a plot: its range, the places of its ticks, and the text of their numbers.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace hapticd::record {

struct Axis {
  std::string label;  ///< name with unit, such as "depth [mm]"
  double low = 0, high = 1;
  bool logarithmic = false;

  /// Returns the place of a value on the axis: 0 at the low end, 1 at the high end, outside of 0 to 1 beyond the ends.
  double share(double value) const;
  /// Returns the value at a place from 0 to 1 on the axis.
  double at(double share) const;
  /// Returns round values within the range, at least two and at most about `most`.
  std::vector<double> ticks(size_t most) const;
};

/// Returns an axis that contains `low` to `high`, with ends at round values. If `low` or `high` is zero, that end is
/// zero.
Axis axisOver(const std::string& label, double low, double high, bool logarithmic = false);

/// Returns the number beside a tick, such as 0.5, 200 or 20k.
std::string tickText(double value);

}  // namespace hapticd::record
