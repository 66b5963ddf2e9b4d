// SPDX-License-Identifier: MIT
#include "kinematics/phantom_dynamics.hpp"

namespace hapticd::kinematics {

PhantomDynamics::PhantomDynamics(const PhantomGeometry& g, const PhantomInertia& i) : rotor_(i.rotor) {
  const double l11 = g.l1 * g.l1, l22 = g.l2 * g.l2, l33 = g.l3 * g.l3;
  base_ =
      0.125 * (4 * (i.a.y() + i.a.z() + 2 * i.base_yy + i.be.y() + i.be.z() + i.c.y() + i.c.z() + i.df.y() + i.df.z()) +
               4 * l11 * g.ma + l22 * g.ma + l11 * g.mc + 4 * l33 * g.mc);
  upper_ = 0.125 * (4 * (i.be.y() - i.be.z() + i.c.y() - i.c.z()) + l11 * (4 * g.ma + g.mc));
  fore_ = 0.125 * (4 * (i.a.y() - i.a.z() + i.df.y() - i.df.z()) - l22 * g.ma - 4 * l33 * g.mc);
  cross_ = 0.5 * g.l1 * (g.l2 * g.ma + g.l3 * g.mc);
  m22_ = i.be.x() + i.c.x() + l11 * g.ma + 0.25 * l11 * g.mc;
  m33_ = i.a.x() + i.df.x() + 0.25 * l22 * g.ma + l33 * g.mc;
}

void PhantomDynamics::evaluate(const Eigen::Vector3d& q, const Eigen::Vector3d& qd, Eigen::Matrix3d& M,
                               Eigen::Vector3d& c) const noexcept {
  evaluate(PhantomAngles(q), qd, M, c);
}

void PhantomDynamics::evaluate(const PhantomAngles& at, const Eigen::Vector3d& qd, Eigen::Matrix3d& M,
                               Eigen::Vector3d& c) const noexcept {
  const double s2 = at.s2, c2 = at.c2, s3 = at.s3, c3 = at.c3;
  const double sin_23 = s2 * c3 - c2 * s3, cos_23 = c2 * c3 + s2 * s3;
  M.setZero();
  M(0, 0) = base_ + upper_ * (c2 * c2 - s2 * s2) + fore_ * (c3 * c3 - s3 * s3) + 2 * cross_ * c2 * s3 + rotor_[0];
  M(1, 1) = m22_ + rotor_[1];
  M(2, 2) = m33_ + rotor_[2];
  M(1, 2) = M(2, 1) = -cross_ * sin_23;

  const double d11_d2 = -4 * upper_ * s2 * c2 - 2 * cross_ * s2 * s3;  // dM11 / dq2
  const double d11_d3 = -4 * fore_ * s3 * c3 + 2 * cross_ * c2 * c3;   // dM11 / dq3
  c[0] = qd[0] * (d11_d2 * qd[1] + d11_d3 * qd[2]);
  c[1] = -0.5 * d11_d2 * qd[0] * qd[0] + cross_ * cos_23 * qd[2] * qd[2];
  c[2] = -0.5 * d11_d3 * qd[0] * qd[0] - cross_ * cos_23 * qd[1] * qd[1];
}

}  // namespace hapticd::kinematics
