#include "premium15.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::simulated {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The literature has x toward the user, y to the right and z up, with the tip at (l1, 0, -l2) for q = 0:
//   x = c1 (l1 c2 + l2 s3),  y = s1 (l1 c2 + l2 s3),  z = l1 s2 - l2 c3.
// Here right = y, up = z + l2, toward the user = x - l1.

Vector3d Phantom::forward(const Joints& q) const noexcept {
  const double reach = links_.upper_arm * std::cos(q[1]) + links_.forearm * std::sin(q[2]);
  return {std::sin(q[0]) * reach, links_.upper_arm * std::sin(q[1]) + links_.forearm * (1 - std::cos(q[2])),
          std::cos(q[0]) * reach - links_.upper_arm};
}

Matrix3d Phantom::jacobian(const Joints& q) const noexcept {
  const double s1 = std::sin(q[0]), c1 = std::cos(q[0]), s2 = std::sin(q[1]), c2 = std::cos(q[1]);
  const double s3 = std::sin(q[2]), c3 = std::cos(q[2]);
  const double l1 = links_.upper_arm, l2 = links_.forearm, reach = l1 * c2 + l2 * s3;
  Matrix3d J;
  J << c1 * reach, -s1 * l1 * s2, s1 * l2 * c3,  //
      0, l1 * c2, l2 * s3,                       //
      -s1 * reach, -c1 * l1 * s2, c1 * l2 * c3;
  return J;
}

Vector3d Phantom::velocityProduct(const Joints& q, const Joints& qd) const noexcept {
  const double s1 = std::sin(q[0]), c1 = std::cos(q[0]), s2 = std::sin(q[1]), c2 = std::cos(q[1]);
  const double s3 = std::sin(q[2]), c3 = std::cos(q[2]);
  const double l1 = links_.upper_arm, l2 = links_.forearm;
  const double reach = l1 * c2 + l2 * s3, reach_d = -l1 * s2 * qd[1] + l2 * c3 * qd[2];
  const double reach_dd = -l1 * c2 * qd[1] * qd[1] - l2 * s3 * qd[2] * qd[2];
  return {s1 * reach_dd + 2 * c1 * qd[0] * reach_d - s1 * qd[0] * qd[0] * reach,
          -l1 * s2 * qd[1] * qd[1] + l2 * c3 * qd[2] * qd[2],
          c1 * reach_dd - 2 * s1 * qd[0] * reach_d - c1 * qd[0] * qd[0] * reach};
}

bool Phantom::inverse(const Vector3d& tip, Joints& q) const noexcept {
  const double l1 = links_.upper_arm, l2 = links_.forearm;
  const double right = tip.x(), up = tip.y() - l2, toward = tip.z() + l1;
  const double reach = std::hypot(right, toward), span2 = reach * reach + up * up;
  const double cosine = (l1 * l1 + l2 * l2 - span2) / (2 * l1 * l2);  // of the angle at the elbow
  if (!(std::abs(cosine) <= 1) || !(span2 > 0)) return false;
  const double span = std::sqrt(span2);
  const double at_shoulder = std::acos(std::clamp((l1 * l1 + span2 - l2 * l2) / (2 * l1 * span), -1.0, 1.0));
  q[0] = std::atan2(right, toward);
  q[1] = std::atan2(up, reach) + at_shoulder;
  // The forearm from the elbow to the tip, measured from the downward vertical.
  q[2] = std::atan2(reach - l1 * std::cos(q[1]), -(up - l1 * std::sin(q[1])));
  return true;
}

Matrix3d PhantomInertia::mass(const Vector3d& q) const noexcept {
  Matrix3d M = Matrix3d::Zero();
  const double coupling = l1 * (l2 * m_a + l3 * m_c);
  M(0, 0) =
      0.125 * (4 * a_yy + 4 * a_zz + 8 * base_yy + 4 * be_yy + 4 * be_zz + 4 * c_yy + 4 * c_zz + 4 * df_yy + 4 * df_zz +
               4 * l1 * l1 * m_a + l2 * l2 * m_a + l1 * l1 * m_c + 4 * l3 * l3 * m_c) +
      0.125 * (4 * be_yy - 4 * be_zz + 4 * c_yy - 4 * c_zz + l1 * l1 * (4 * m_a + m_c)) * std::cos(2 * q[1]) +
      0.125 * (4 * a_yy - 4 * a_zz + 4 * df_yy - 4 * df_zz - l2 * l2 * m_a - 4 * l3 * l3 * m_c) * std::cos(2 * q[2]) +
      coupling * std::cos(q[1]) * std::sin(q[2]);
  M(1, 1) = 0.25 * (4 * (be_xx + c_xx + l1 * l1 * m_a) + l1 * l1 * m_c);
  M(1, 2) = M(2, 1) = -0.5 * coupling * std::sin(q[1] - q[2]);
  M(2, 2) = 0.25 * (4 * a_xx + 4 * df_xx + l2 * l2 * m_a + 4 * l3 * l3 * m_c);
  return M;
}

Vector3d PhantomInertia::coriolis(const Vector3d& q, const Vector3d& qd) const noexcept {
  // From the partial derivatives of the mass matrix: C qd = (dM/dt) qd - (1/2) d(qd^T M qd)/dq.
  const double coupling = l1 * (l2 * m_a + l3 * m_c);
  const double m00_q2 =
      -0.25 * (4 * be_yy - 4 * be_zz + 4 * c_yy - 4 * c_zz + l1 * l1 * (4 * m_a + m_c)) * std::sin(2 * q[1]) -
      coupling * std::sin(q[1]) * std::sin(q[2]);
  const double m00_q3 =
      -0.25 * (4 * a_yy - 4 * a_zz + 4 * df_yy - 4 * df_zz - l2 * l2 * m_a - 4 * l3 * l3 * m_c) * std::sin(2 * q[2]) +
      coupling * std::cos(q[1]) * std::cos(q[2]);
  const double m12_q2 = -0.5 * coupling * std::cos(q[1] - q[2]);  // and the opposite by q3
  const double m00_d = m00_q2 * qd[1] + m00_q3 * qd[2], m12_d = m12_q2 * (qd[1] - qd[2]);
  const double cross = m12_q2 * qd[1] * qd[2];
  return {m00_d * qd[0], m12_d * qd[2] - 0.5 * m00_q2 * qd[0] * qd[0] - cross,
          m12_d * qd[1] - 0.5 * m00_q3 * qd[0] * qd[0] + cross};
}

Vector3d PhantomInertia::gravity(const Vector3d& q, double g) const noexcept {
  return {0, 0.5 * g * (2 * l1 * m_a + 2 * l5 * m_be + l1 * m_c) * std::cos(q[1]),
          0.5 * g * (l2 * m_a + 2 * l3 * m_c - 2 * l6 * m_df) * std::sin(q[2])};
}

}  // namespace hapticd::simulated
