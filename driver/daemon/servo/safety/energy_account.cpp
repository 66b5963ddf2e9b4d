// SPDX-License-Identifier: MIT
#include "servo/safety/energy_account.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::servo {

void EnergyAccount::add(const Eigen::Vector3d& force, const Eigen::Vector3d& position, double depth,
                        LastPush& last) noexcept HSP_RT {
  const double stored = force.norm() * std::max(depth, 0.0);
  // Nobody knows how a probe that jumped came to its depth, so the contact counts as pressed by a hand.
  double work = -stored;
  if (last.known) work = (last.force + force).dot(position - last.position) / 2;
  // After a late tick, or a jump of the path, a probe that left is far away. It was pushed over its depth alone.
  if (last.known && force.isZero(0)) work = std::min(work, last.stored / 2);
  given_ += work;
  stored_ += stored;
  last = {force, position, stored, true};
}

bool EnergyAccount::closeStep(double dt, double reported) noexcept HSP_RT {
  // What friction and damping took cannot be given back, so it must not hide what is given later. But friction that
  // sticks is a spring, which may store more than the wall.
  given_ = std::max(given_, -std::max(stored_, reported));
  if (given_ > 0) given_ = std::max(0.0, given_ - kMostPower * dt);
  stored_ = 0;
  if (!std::isfinite(given_)) given_ = 0;
  return given_ > kMostGiven;
}

}  // namespace hapticd::servo
