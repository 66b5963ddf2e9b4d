// SPDX-License-Identifier: MIT
/// Family jacobian_torque: wrench, Jacobian and torques of an arm with a spherical wrist (Thompson et al. 1999, Eq.
/// 7-9).
#include "kinematics/chain.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

using namespace hapticd::kinematics;

std::vector<double> numbers(const Json& values) {
  std::vector<double> all;
  for (const Json& value : values) all.push_back(number(value));
  return all;
}

Eigen::Vector3d vector3(const Json& values) {
  const std::vector<double> all = numbers(values);
  return {all.at(0), all.at(1), all.at(2)};
}

Chain chainOf(const Json& input) {
  const auto twists = numbers(input["alpha_over_half_pi"]), d = numbers(input["d"]), a = numbers(input["a"]);
  ChainGeometry geometry;
  for (size_t i = 0; i < twists.size(); ++i) {
    ChainLink link;
    link.alpha = twists[i] * M_PI / 2;
    link.d = d.at(i);
    link.a = a.at(i);
    geometry.links.push_back(link);
  }
  return Chain(geometry);
}

void jacobianTorque(const Case& test, Check& check) {
  constexpr size_t kWristJoint = 5;  // the first whose axis passes through the wrist (b = 0 from here on)
  const Chain chain = chainOf(test.input);
  const auto q = numbers(test.input["q"]);
  const double tolerance = number(test.tol["abs"]);
  ChainFrames at;
  chain.frames(Eigen::Map<const Eigen::VectorXd>(q.data(), static_cast<Eigen::Index>(q.size())), at);
  const Eigen::Vector3d wrist = at.o[std::min(kWristJoint, q.size())];
  const Jacobian J = chain.jacobianAt(at, wrist, chain.jointCount());
  // As the daemon does it: the force at the tip of the finger, through the Jacobian there.
  const Eigen::Vector3d force = vector3(test.input["force"]), offset = vector3(test.input["finger_offset_world"]);
  const Jacobian J_tip = chain.jacobianAt(at, wrist + offset, chain.jointCount());
  const Eigen::VectorXd tau = J_tip.topRows<3>().transpose() * force;

  check.nearVector("wrist", wrist, test.expect["wrist"], tolerance);
  for (int row = 0; row < 6; ++row)
    check.nearVector("J[" + std::to_string(row) + "]", Eigen::VectorXd(J.row(row).transpose()),
                     test.expect["J"][static_cast<size_t>(row)], tolerance);
  check.nearVector("tau", tau, test.expect["tau"], tolerance);
  // The wrench at the wrist that the case states (Eq. 7) asks for the same torques (Eq. 9).
  const std::vector<double> stated = numbers(test.expect["wrench"]);
  const Eigen::VectorXd by_wrench = J.transpose() * Eigen::Map<const Eigen::Matrix<double, 6, 1>>(stated.data());
  check.nearVector("tau by the wrench", by_wrench, test.expect["tau"], tolerance * std::max(1.0, tau.norm()));
}

}  // namespace
}  // namespace hapticd::verify

HAPTICD_VERIFY(jacobian_torque, hapticd::verify::jacobianTorque)
