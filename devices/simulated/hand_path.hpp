// SPDX-License-Identifier: MIT
/// A path for the hand from a CSV file with the columns t,x,y,z (s, m, device frame).
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "document/csv.hpp"

namespace hapticd::simulated {

class HandPath {
 public:
  HandPath() = default;
  /// [main] Reads a file. Throws std::runtime_error that names file, line and what was expected.
  static HandPath read(const std::string& file);
  /// [main] Reads the same from text; messages call it `name`.
  static HandPath parse(const std::string& text, const std::string& name);

  /// [rt] The path is straight between the rows; before the first and after the last row the hand rests there.
  void at(double t, Eigen::Vector3d& position, Eigen::Vector3d& velocity) const noexcept;
  bool empty() const noexcept { return times_.empty(); }

 private:
  explicit HandPath(const document::CsvTable& table);

  std::vector<double> times_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace hapticd::simulated
