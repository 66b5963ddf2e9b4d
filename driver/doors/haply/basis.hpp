// SPDX-License-Identifier: MIT
/// The axes that a program of Haply's interface counts in. Theirs by default: x right, y away from the user, z up;
/// hapticd's world: x right, y up, z to the user.
#pragma once
#include <array>
#include <string>

namespace hapticd::haply {

class Basis {
 public:
  /// A permutation in Haply's form, such as "XZY" or "X-YZ". False if it is not one; then nothing changes.
  bool set(const std::string& permutation);
  std::array<double, 3> fromWorld(const double v[3]) const;
  std::array<double, 3> toWorld(const double v[3]) const;
  /// A unit quaternion w, x, y, z: the axis of a turn is a vector, whose direction is reversed by a mirrored basis.
  std::array<double, 4> turnFromWorld(const double q[4]) const;

 private:
  bool mirrored() const;
  std::array<int, 3> axis_{0, 1, 2};  ///< axis of Haply's frame for each of the program's
  std::array<double, 3> sign_{1, 1, 1};
};

}  // namespace hapticd::haply
