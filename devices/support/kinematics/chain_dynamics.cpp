// SPDX-License-Identifier: MIT
#include "kinematics/chain_dynamics.hpp"

namespace hapticd::kinematics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Mass, first moment and second moment of a body about the origin of the device frame. For several bodies they add up.
struct Body {
  double mass = 0;
  Vector3d moment = Vector3d::Zero();
  Matrix3d inertia = Matrix3d::Zero();
};

Body bodyOf(const ChainLink& link, const Matrix3d& R, const Vector3d& center) noexcept {
  Body body;
  body.mass = link.mass;
  body.moment = link.mass * center;
  body.inertia = R * link.inertia * R.transpose() +
                 link.mass * (center.squaredNorm() * Matrix3d::Identity() - center * center.transpose());
  return body;
}

/// Velocity (or acceleration) of a body as a twist about the origin of the device frame.
struct Twist {
  Vector3d angular = Vector3d::Zero(), linear = Vector3d::Zero();  ///< linear: of the body's point at that origin
};

Twist axisOf(const Chain& chain, const ChainFrames& at, size_t joint) noexcept {
  const Vector3d z = at.R[joint].col(2);
  if (chain.links()[joint].sliding) return {Vector3d::Zero(), z};
  return {z, at.o[joint].cross(z)};
}

/// Momentum of a body about the origin of the device frame.
Twist momentum(const Body& body, const Twist& v) noexcept {
  return {body.inertia * v.angular + body.moment.cross(v.linear), body.mass * v.linear - body.moment.cross(v.angular)};
}

double work(const Twist& axis, const Twist& force) noexcept {
  return axis.angular.dot(force.angular) + axis.linear.dot(force.linear);
}

}  // namespace

void chainDynamics(const Chain& chain, const ChainFrames& at, const JointVector& qd, MassMatrix& M,
                   JointVector& c) noexcept {
  const auto count = static_cast<size_t>(chain.jointCount());
  std::array<Twist, kMaxJoints> axes, forces;
  std::array<Body, kMaxJoints> bodies;
  Twist v, a;  // velocity of the current link, and its acceleration if no joint accelerates
  for (size_t i = 0; i < count; ++i) {
    const ChainLink& link = chain.links()[i];
    axes[i] = axisOf(chain, at, i);
    bodies[i] = bodyOf(link, at.R[i + 1], at.o[i + 1] + at.R[i + 1] * link.center);
    const double rate = qd[static_cast<int>(i)];
    a.angular += rate * v.angular.cross(axes[i].angular);
    a.linear += rate * (v.angular.cross(axes[i].linear) + v.linear.cross(axes[i].angular));
    v.angular += rate * axes[i].angular;
    v.linear += rate * axes[i].linear;
    const Twist p = momentum(bodies[i], v);
    forces[i] = momentum(bodies[i], a);
    forces[i].angular += v.angular.cross(p.angular) + v.linear.cross(p.linear);
    forces[i].linear += v.angular.cross(p.linear);
  }
  M.resize(chain.jointCount(), chain.jointCount());
  c.resize(chain.jointCount());
  Body hanging;
  Twist force;
  for (size_t i = count; i-- > 0;) {
    hanging.mass += bodies[i].mass;
    hanging.moment += bodies[i].moment;
    hanging.inertia += bodies[i].inertia;
    force.angular += forces[i].angular;
    force.linear += forces[i].linear;
    const int row = static_cast<int>(i);
    c[row] = work(axes[i], force);
    const Twist p = momentum(hanging, axes[i]);
    for (size_t j = 0; j <= i; ++j) M(row, static_cast<int>(j)) = M(static_cast<int>(j), row) = work(axes[j], p);
  }
}

}  // namespace hapticd::kinematics
