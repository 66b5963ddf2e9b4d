// SPDX-License-Identifier: MIT
#include "kernels/dynamics/rigid_body.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

void rigidFree(const Case& c, Check& check) {
  const Json& in = c.input;
  dynamics::RigidBodyLaw law;
  const Eigen::Vector3d moments(number(in["I"][0]), number(in["I"][1]), number(in["I"][2]));
  law.inertia = moments.asDiagonal();
  dynamics::RigidBody body(law, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero());
  const Json& start = in["omega0"];
  body.setVelocity(Eigen::Vector3d::Zero(), {number(start[0]), number(start[1]), number(start[2])});
  const double time = number(in["t"]);
  const int ticks = static_cast<int>(std::ceil(time * 1000));
  for (int i = 0; i < ticks; ++i) body.step(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), time / ticks);
  const double tolerance = number(c.tol["abs"]);
  check.nearVector("omega", body.bodyRate(), c.expect["omega"], tolerance);
  check.near("energy", body.energy(), c.expect["energy"], tolerance);
  check.near("momentum", body.momentum().norm(), c.expect["L_norm"], tolerance);
}

}  // namespace
HAPTICD_VERIFY(rigid_free, rigidFree)
}  // namespace hapticd::verify
