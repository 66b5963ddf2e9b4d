// SPDX-License-Identifier: MIT
#include "rotation.hpp"

#include <algorithm>
#include <cmath>

#include "units.hpp"

namespace hapticd::hd {

namespace {

double& at(double* transform, int row, int column) {
  return transform[4 * column + row];
}

}  // namespace

void toTransform(const hapticd_state& state, double out[16]) {
  const double w = state.orientation[0], x = state.orientation[1], y = state.orientation[2], z = state.orientation[3];
  std::fill_n(out, 16, 0.0);
  at(out, 0, 0) = 1 - 2 * (y * y + z * z), at(out, 0, 1) = 2 * (x * y - w * z), at(out, 0, 2) = 2 * (x * z + w * y);
  at(out, 1, 0) = 2 * (x * y + w * z), at(out, 1, 1) = 1 - 2 * (x * x + z * z), at(out, 1, 2) = 2 * (y * z - w * x);
  at(out, 2, 0) = 2 * (x * z - w * y), at(out, 2, 1) = 2 * (y * z + w * x), at(out, 2, 2) = 1 - 2 * (x * x + y * y);
  for (int i = 0; i < 3; ++i) at(out, i, 3) = state.position[i] * kMmPerMetre;
  at(out, 3, 3) = 1;
}

void scaleAngles(const double scale[3], double transform[16]) {
  const double b = scale[1] * std::asin(std::clamp(-at(transform, 1, 2), -1.0, 1.0));
  const double a = scale[0] * std::atan2(at(transform, 0, 2), at(transform, 2, 2));
  const double c = scale[2] * std::atan2(at(transform, 1, 0), at(transform, 1, 1));
  const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b), cc = std::cos(c),
               sc = std::sin(c);
  at(transform, 0, 0) = ca * cc + sa * sb * sc, at(transform, 0, 1) = -ca * sc + sa * sb * cc,
                   at(transform, 0, 2) = sa * cb;
  at(transform, 1, 0) = cb * sc, at(transform, 1, 1) = cb * cc, at(transform, 1, 2) = -sb;
  at(transform, 2, 0) = -sa * cc + ca * sb * sc, at(transform, 2, 1) = sa * sc + ca * sb * cc,
                   at(transform, 2, 2) = ca * cb;
}

}  // namespace hapticd::hd
