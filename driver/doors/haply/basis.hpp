// SPDX-License-Identifier: MIT
/// The axes of the vectors that a program with Haply's interface sends and receives. By default they are Haply's axes:
/// x right, y away from the user, z up. The axes of hapticd's world are x right, y up, z toward the user.
#pragma once
#include <array>
#include <string>

namespace hapticd::haply {

class Basis {
 public:
  /// Sets a permutation in Haply's form, such as "XZY" or "X-YZ". Returns false and changes nothing if the text is not
  /// a permutation.
  bool set(const std::string& permutation);
  std::array<double, 3> fromWorld(const double v[3]) const;
  std::array<double, 3> toWorld(const double v[3]) const;
  /// Converts an orientation, a unit quaternion w, x, y, z. A mirrored basis also reverses the sense of the turn.
  std::array<double, 4> turnFromWorld(const double q[4]) const;

 private:
  bool mirrored() const;
  std::array<int, 3> axis_{0, 1, 2};  ///< Haply's axis (0 to 2) for each axis of the program
  std::array<double, 3> sign_{1, 1, 1};
};

}  // namespace hapticd::haply
