// SPDX-License-Identifier: MIT
#include "motion.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::hd {

void Motion::add(const hapticd_state& state) {
  if (count_ > 0 && state.tick <= at(0).tick) {
    if (state.tick == at(0).tick) return;
    count_ = 0;  // another daemon has started, and counts its ticks from 0
  }
  kept_[next_] = state;
  next_ = (next_ + 1) % kKept;
  count_ = std::min(count_ + 1, kKept);
}

void Motion::velocity(double out[3]) const {
  std::fill_n(out, 3, 0.0);
  double middle = 0, spread = 0;
  for (size_t i = 0; i < count_; ++i) middle += at(i).t / static_cast<double>(count_);
  for (size_t i = 0; i < count_; ++i) spread += (at(i).t - middle) * (at(i).t - middle);
  if (!(spread > 0)) return;
  for (size_t i = 0; i < count_; ++i)
    for (int axis = 0; axis < 3; ++axis) out[axis] += (at(i).t - middle) * at(i).position[axis] / spread;
}

void Motion::angularVelocity(double out[3]) const {
  std::fill_n(out, 3, 0.0);
  if (count_ < 2) return;
  const hapticd_state &newest = at(0), &oldest = at(count_ - 1);
  const double time = newest.t - oldest.t;
  const double *b = newest.orientation, *a = oldest.orientation;
  // The rotation from a to b is b * conj(a). Its vector part is the axis times the sine of half the angle.
  const double w = b[0] * a[0] + b[1] * a[1] + b[2] * a[2] + b[3] * a[3];
  const double v[3] = {-b[0] * a[1] + b[1] * a[0] - b[2] * a[3] + b[3] * a[2],
                       -b[0] * a[2] + b[1] * a[3] + b[2] * a[0] - b[3] * a[1],
                       -b[0] * a[3] - b[1] * a[2] + b[2] * a[1] + b[3] * a[0]};
  const double sine = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (!(time > 0) || !(sine > 0)) return;
  const double angle = 2 * std::atan2(sine, std::abs(w)) * (w < 0 ? -1 : 1);
  for (int axis = 0; axis < 3; ++axis) out[axis] = v[axis] / sine * angle / time;
}

}  // namespace hapticd::hd
