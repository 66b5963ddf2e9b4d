// SPDX-License-Identifier: MIT
#include "basis.hpp"

namespace hapticd::haply {

bool Basis::set(const std::string& permutation) {
  std::array<int, 3> axis{};
  std::array<double, 3> sign{1, 1, 1};
  size_t place = 0;
  bool seen[3] = {};
  for (size_t i = 0; i < permutation.size(); ++i) {
    const char c = permutation[i];
    if (place == 3) return false;
    if (c == '-' || c == '+') {
      if (i + 1 == permutation.size() || permutation[i + 1] < 'X') return false;
      sign[place] = c == '-' ? -1 : 1;
      continue;
    }
    if (c < 'X' || c > 'Z' || seen[c - 'X']) return false;
    seen[c - 'X'] = true;
    axis[place++] = c - 'X';
  }
  if (place != 3) return false;
  axis_ = axis, sign_ = sign;
  return true;
}

std::array<double, 3> Basis::fromWorld(const double v[3]) const {
  const double haply[3] = {v[0], -v[2], v[1]};
  std::array<double, 3> theirs{};
  for (size_t i = 0; i < 3; ++i) theirs[i] = sign_[i] * haply[axis_[i]];
  return theirs;
}

std::array<double, 3> Basis::toWorld(const double v[3]) const {
  double haply[3] = {};
  for (size_t i = 0; i < 3; ++i) haply[axis_[i]] = sign_[i] * v[i];
  return {haply[0], haply[2], -haply[1]};
}

bool Basis::mirrored() const {
  const bool even = (axis_[1] - axis_[0] + 3) % 3 == 1;
  return (sign_[0] * sign_[1] * sign_[2] < 0) == even;
}

std::array<double, 4> Basis::turnFromWorld(const double q[4]) const {
  const auto v = fromWorld(q + 1);
  const double sense = mirrored() ? -1 : 1;
  return {q[0], sense * v[0], sense * v[1], sense * v[2]};
}

}  // namespace hapticd::haply
