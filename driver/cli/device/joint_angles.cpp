// SPDX-License-Identifier: MIT
#include "cli/device/joint_angles.hpp"

#include <cmath>
#include <cstdio>

namespace hapticd::cli {
namespace {

/// Returns true for a position that hardly any joint has in rad. Positions that were recorded over several turns are no
/// whole numbers.
bool looksLikeDegrees(double q) {
  constexpr double kTurns = 10, kManyTurns = 50;  // [rad]
  return std::abs(q) >= kTurns && (q == std::round(q) || std::abs(q) > kManyTurns);
}

}  // namespace

bool slides(const host::DeviceInstance& device, uint32_t joint) {
  constexpr double kSmall = 1e-6;
  const uint32_t n = device.kinematics().joint_count;
  std::vector<double> J(size_t{6} * n);
  for (const double at : {0.1, 0.2}) {  // in a single pose, a joint that turns may look the same
    const std::vector<double> q(n, at);
    if (device.kinematics().jacobian(device.handle(), q.data(), J.data()) < 0) return false;
    double moves = 0, turns = 0;
    for (uint32_t row = 0; row < 6; ++row) (row < 3 ? moves : turns) += J[row * n + joint] * J[row * n + joint];
    if (turns > kSmall || std::abs(moves - 1) > kSmall) return false;
  }
  return true;
}

void warnOfDegrees(const std::string& file, const document::CsvTable& table, const std::vector<size_t>& columns,
                   const host::DeviceInstance& device) {
  for (size_t row = 0; row < table.rows(); ++row)
    for (uint32_t joint = 0; joint < columns.size(); ++joint) {
      const double q = table.row(row)[columns[joint]];
      if (!looksLikeDegrees(q) || slides(device, joint)) continue;
      std::fprintf(
          stderr,
          "warning: %s: line %d: joint %u: %g rad is %.3g turns; positions must be in rad: %g degrees is %.4g rad\n",
          file.c_str(), table.lines[row], joint + 1, q, std::abs(q) / (2 * M_PI), q, q * M_PI / 180);
      return;
    }
}

}  // namespace hapticd::cli
