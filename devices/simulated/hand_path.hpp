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
  /// [main] Reads a file. Throws std::runtime_error with one line for each problem, which names the file, the line and
  /// what was expected.
  static HandPath read(const std::string& file);
  /// [main] Reads the same columns from a text. Messages call the text `name`.
  static HandPath parse(const std::string& text, const std::string& name);

  /// [rt] Computes position and velocity at time `t` [s]. The path is straight between two rows; before the first row
  /// and after the last row the hand rests at that row.
  void at(double t, Eigen::Vector3d& position, Eigen::Vector3d& velocity) const noexcept;
  bool empty() const noexcept { return times_.empty(); }
  /// [main] Returns the place of the first row, such as "path.csv:2:1".
  std::string firstPlace() const { return file_ + ":" + std::to_string(first_line_) + ":1"; }

 private:
  HandPath(const document::CsvTable& table, std::string file);

  std::string file_;
  int first_line_ = 1;
  std::vector<double> times_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace hapticd::simulated
