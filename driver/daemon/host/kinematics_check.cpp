// SPDX-License-Identifier: MIT
#include "host/kinematics_check.hpp"

#include <cstdio>
#include <optional>

#include "host/kinematics_calls.hpp"
#include "host/kinematics_places.hpp"

namespace hapticd::host {
namespace {

using Twist = Eigen::Matrix<double, 6, 1>;
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kStep = 1e-5;    ///< [rad or m] step of the differences; their error is about 1e-10 of the arm's size
constexpr double kWrong = 0.02;   ///< allowed error, as a share of the longest column; rounding causes less
constexpr double kSmooth = 1e-3;  ///< if the differences for two steps differ by more than this share, J is not smooth
/// [m/rad] errors are compared with the longest column, or with this length if it is larger
constexpr double kLeastColumn = 1e-3;

std::optional<Tip> tipAt(const KinematicsCalls& calls, const Joints& q) {
  Tip tip;
  if (calls.forward(q, tip) < 0) return std::nullopt;
  if (!tip.position.allFinite() || !tip.orientation.coeffs().allFinite()) return std::nullopt;
  return tip;
}

/// Returns the central difference of the tip's pose with respect to one joint: rows 0 to 2 are the linear velocity,
/// rows 3 to 5 the angular velocity.
std::optional<Twist> difference(const KinematicsCalls& calls, Joints q, Eigen::Index joint, double step) {
  q[joint] += step;
  const auto after = tipAt(calls, q);
  q[joint] -= 2 * step;
  const auto before = tipAt(calls, q);
  if (!after || !before) return std::nullopt;
  Eigen::Vector3d turned = (after->orientation * before->orientation.conjugate()).vec();
  if (after->orientation.dot(before->orientation) < 0) turned = -turned;
  Twist twist;
  twist << (after->position - before->position) / (2 * step), turned / step;
  return twist;
}

std::string said(const Eigen::Vector3d& v) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", v.x(), v.y(), v.z());
  return text;
}

std::string complaint(Eigen::Index joint, bool turns, const Twist& is, const Twist& given, const Joints& q,
                      Eigen::Index n) {
  const auto rows = [turns](const Twist& twist) -> Eigen::Vector3d {
    return turns ? twist.tail<3>() : twist.head<3>();
  };
  return "has a Jacobian that is not the derivative of its forward kinematics, "
         "so a force would have a wrong direction or size: with the joints at " +
         placeText(q, n) + ", joint " + std::to_string(joint + 1) +
         (turns ? " turns the tip by " : " moves the tip by ") + said(rows(is)) + (turns ? " rad" : " m") +
         " per rad (or m) of the joint, but column " + std::to_string(joint + 1) + " of its Jacobian has " +
         said(rows(given)) +
         "; expected J[row * joint_count + joint], rows 0-2 linear, 3-5 angular velocity in the device frame";
}

std::string wrongAt(const KinematicsCalls& calls, const Joints& q) {
  const Eigen::Index n = calls.joints();
  KinematicsCalls::JacobianRoom room(static_cast<size_t>(6 * n));
  if (!tipAt(calls, q) || calls.jacobian(q, room) < 0) return "";
  const Jacobian J = Eigen::Map<const Jacobian>(room.data(), 6, n);
  const bool turns = !J.bottomRows<3>().isZero(0);
  Jacobian is = J;
  for (Eigen::Index j = 0; j < is.cols(); ++j) {
    const auto fine = difference(calls, q, j, kStep), coarse = difference(calls, q, j, 2 * kStep);
    if (!fine || !coarse || !((*fine - *coarse).norm() <= kSmooth * (kLeastColumn + fine->norm()))) return "";
    is.col(j) = *fine;
  }
  for (const bool angular : {false, true}) {
    if (angular && !turns) continue;
    const Eigen::Index row = angular ? 3 : 0;
    const double longest = std::max(kLeastColumn, is.middleRows<3>(row).colwise().norm().maxCoeff());
    for (Eigen::Index j = 0; j < is.cols(); ++j)
      if (const double off = (is - J).middleRows<3>(row).col(j).norm(); !(off <= kWrong * longest))
        return complaint(j, angular, is.col(j), J.col(j), q, n);
  }
  return "";
}

}  // namespace

std::string wrongJacobian(const hdv_ext_kinematics& kinematics, const hdv_device* device) {
  if (kinematics.joint_count == 0 || kinematics.joint_count > HDV_MAX_JOINTS) return "";  // open() reports this error
  const KinematicsCalls calls(kinematics, device);
  for (int i = 0; i < kPlaces; ++i)
    if (std::string wrong = wrongAt(calls, anyPlace(i)); !wrong.empty()) return wrong;
  return "";
}

}  // namespace hapticd::host
