// SPDX-License-Identifier: MIT
#include "simulated/hand_path.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace hapticd::simulated {
namespace {

constexpr size_t kMaxBytes = size_t{1} << 30;

document::CsvRules rules() {
  return {{"t,x,y,z", "t,x,y,z,qw,qx,qy,qz"}, true, true};
}

document::CsvTable orThrow(std::optional<document::CsvTable> table, const document::Problems& problems) {
  if (table) return std::move(*table);
  std::string all;
  for (const document::Problem& problem : problems) all.append(all.empty() ? "" : "\n").append(problem.text());
  throw std::runtime_error(all);
}

}  // namespace

HandPath::HandPath(const document::CsvTable& table, std::string file)
    : file_(std::move(file)), first_line_(table.lines.empty() ? 1 : table.lines.front()) {
  for (size_t i = 0; i < table.rows(); ++i) {
    times_.push_back(table.row(i)[0]);
    points_.emplace_back(table.row(i)[1], table.row(i)[2], table.row(i)[3]);
  }
}

HandPath HandPath::read(const std::string& file) {
  document::Problems problems;
  return HandPath(orThrow(document::readCsv(file, kMaxBytes, rules(), problems), problems), file);
}

HandPath HandPath::parse(const std::string& text, const std::string& name) {
  document::Problems problems;
  return HandPath(orThrow(document::parseCsv(text, name, rules(), problems), problems), name);
}

void HandPath::at(double t, Eigen::Vector3d& position, Eigen::Vector3d& velocity) const noexcept {
  velocity.setZero();
  const auto next = std::upper_bound(times_.begin(), times_.end(), t);
  const auto i = static_cast<size_t>(next - times_.begin());
  if (i == 0 || i == times_.size()) {
    position = i == 0 ? points_.front() : points_.back();
    return;
  }
  velocity = (points_[i] - points_[i - 1]) / (times_[i] - times_[i - 1]);
  position = points_[i - 1] + (t - times_[i - 1]) * velocity;
}

}  // namespace hapticd::simulated
