// SPDX-License-Identifier: MIT
#include "kernels/dynamics/rotation.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

void rigidRotation(const Case& c, Check& check) {
  const Json& in = c.input;
  const Eigen::Vector3d axis(number(in["axis"][0]), number(in["axis"][1]), number(in["axis"][2]));
  const Eigen::Vector3d point(number(in["point"][0]), number(in["point"][1]), number(in["point"][2]));
  const Eigen::Vector3d turn = axis.normalized() * (number(in["omega"]) * number(in["dt"]));
  const auto ticks = in["N"].get<long>();
  dynamics::Rotation rotation;
  for (long i = 0; i < ticks; ++i) rotation.turnWorld(turn);
  const double tolerance =
      std::max(number(c.tol["abs_floor"]), number(c.tol["abs_per_tick"]) * static_cast<double>(ticks));
  check.nearVector("image", rotation.quaternion() * point, c.expect["image"], tolerance);
}

}  // namespace
HAPTICD_VERIFY(rigid_rotation, rigidRotation)
}  // namespace hapticd::verify
