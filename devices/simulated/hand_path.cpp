#include "hand_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace hapticd::simulated {
namespace {

constexpr size_t kMaxRows = 10'000'000;

/// Four numbers of one row, or false.
bool numbersOf(const std::string& row, double (&values)[4]) {
  const char* at = row.c_str();
  for (int i = 0; i < 4; ++i) {
    char* end = nullptr;
    values[i] = std::strtod(at, &end);
    if (end == at || !std::isfinite(values[i])) return false;
    at = end;
    while (*at == ' ' || *at == '\t') ++at;
    if (i < 3 && *at++ != ',') return false;
  }
  return *at == '\0' || *at == ',' || *at == '\r';
}

}  // namespace

HandPath HandPath::read(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + ": cannot be read, expected a CSV file with the columns t,x,y,z");
  std::ostringstream text;
  text << in.rdbuf();
  return parse(text.str(), file);
}

HandPath HandPath::parse(const std::string& text, const std::string& name) {
  HandPath path;
  std::istringstream in(text);
  std::string row;
  for (size_t line = 1; std::getline(in, row); ++line) {
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error(name + ":" + std::to_string(line) + ": " + what);
    };
    if (row.empty() || row == "\r" || row[0] == '#' || (line == 1 && row.rfind("t,x,y,z", 0) == 0)) continue;
    double values[4];
    if (!numbersOf(row, values)) fail(row.substr(0, 60).append(" is no row, expected four finite numbers t,x,y,z"));
    if (!path.times_.empty() && values[0] <= path.times_.back()) fail("time does not grow, expected growing times");
    if (path.times_.size() == kMaxRows) fail("more than 10 million rows, expected fewer");
    path.times_.push_back(values[0]);
    path.points_.emplace_back(values[1], values[2], values[3]);
  }
  if (path.empty()) throw std::runtime_error(name + ": no rows, expected at least one row t,x,y,z");
  return path;
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
