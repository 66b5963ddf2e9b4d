// SPDX-License-Identifier: MIT
/// An axis of a plot: its range, where its ticks are, and how their numbers are written.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace hapticd::record {

struct Axis {
  std::string label;  ///< with its unit, "depth [mm]"
  double low = 0, high = 1;
  bool logarithmic = false;

  /// 0 at the low end, 1 at the high end; values beyond the ends lie outside 0 to 1.
  double share(double value) const;
  /// The value at a share of the axis.
  double at(double share) const;
  /// Round values within the range, at least two and at most about `most`.
  std::vector<double> ticks(size_t most) const;
};

/// An axis that holds everything from `low` to `high`, with ends at round values. An end at zero stays there.
Axis axisOver(const std::string& label, double low, double high, bool logarithmic = false);

/// The number beside a tick: 0.5, 200, 20k.
std::string tickText(double value);

}  // namespace hapticd::record
