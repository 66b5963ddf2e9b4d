// SPDX-License-Identifier: MIT
#include "kinematics/phantom.hpp"

#include <cmath>

#include "kinematics/assign_list.hpp"
#include "kinematics/error_collector.hpp"

namespace hapticd::kinematics {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kOpening = 55 * kDegree, kClosing = 65 * kDegree;  ///< [rad] limits of q3 - q2 and of q2 - q3

/// Returns the Jacobian of the point that is a c2 + b s3 away from the axis and a s2 - b c3 above the shoulder, turned
/// by q1. With a and b the link lengths this point is the tip; with the first moments it is the (weighted) centre of
/// mass.
Eigen::Matrix3d planarJacobian(double a, double b, const PhantomAngles& at) noexcept {
  const auto [s1, c1, s2, c2, s3, c3] = at;
  const double r = a * c2 + b * s3;
  Eigen::Matrix3d J;
  J << r * c1, -a * s2 * s1, b * c3 * s1,  //
      0, a * c2, b * s3,                   //
      -r * s1, -a * s2 * c1, b * c3 * c1;
  return J;
}

double wrapped(double angle) noexcept {
  return std::remainder(angle, 2 * M_PI);
}

/// Adds full turns to `angle`, so that the result is nearest to `reference`.
double nearest(double angle, double reference) noexcept {
  return reference + wrapped(angle - reference);
}

}  // namespace

PhantomGeometry phantomGeometry(const std::vector<double>& lengths, const std::vector<double>& masses,
                                const Eigen::Vector3d& origin) {
  PhantomGeometry g;
  ErrorCollector wrong;
  wrong.attempt([&] { assignList(lengths, "arm.lengths", g.l1, g.l2, g.l3, g.l5, g.l6); });
  wrong.attempt([&] { assignList(masses, "arm.masses", g.ma, g.mc, g.mbe, g.mdf); });
  wrong.check();
  g.origin = origin;
  return g;
}

double Phantom::largestOpening() noexcept {
  return kOpening;
}
double Phantom::largestClosing() noexcept {
  return kClosing;
}

Phantom::Phantom(const PhantomGeometry& geometry)
    : geometry_(geometry),
      moment2_(geometry.l1 * geometry.ma + geometry.l5 * geometry.mbe + 0.5 * geometry.l1 * geometry.mc),
      moment3_(0.5 * geometry.l2 * geometry.ma + geometry.l3 * geometry.mc - geometry.l6 * geometry.mdf) {
  limits_.min = Eigen::Vector3d(-90, -124, -29) * kDegree;
  limits_.max = Eigen::Vector3d(90, 119, 214) * kDegree;
}

PhantomAngles::PhantomAngles(const Eigen::Vector3d& q) noexcept
    : s1(std::sin(q[0])),
      c1(std::cos(q[0])),
      s2(std::sin(q[1])),
      c2(std::cos(q[1])),
      s3(std::sin(q[2])),
      c3(std::cos(q[2])) {}

Eigen::Vector3d Phantom::position(const PhantomAngles& at) const noexcept {
  const double r = geometry_.l1 * at.c2 + geometry_.l2 * at.s3;
  const double h = geometry_.l1 * at.s2 - geometry_.l2 * at.c3;
  return geometry_.origin + Eigen::Vector3d(r * at.s1, h + geometry_.l2, r * at.c1 - geometry_.l1);
}

Eigen::Vector3d Phantom::position(const Eigen::Vector3d& q) const noexcept {
  return position(PhantomAngles(q));
}

bool Phantom::forward(const JointVector& q, Pose& tip) const noexcept {
  tip.position = position(q.head<3>());
  tip.orientation.setIdentity();
  return true;
}

Eigen::Matrix3d Phantom::positionJacobian(const PhantomAngles& at) const noexcept {
  return planarJacobian(geometry_.l1, geometry_.l2, at);
}

Eigen::Matrix3d Phantom::positionJacobian(const Eigen::Vector3d& q) const noexcept {
  return positionJacobian(PhantomAngles(q));
}

bool Phantom::jacobian(const JointVector& q, Jacobian& J) const noexcept {
  J.setZero(6, 3);
  J.topRows<3>() = positionJacobian(q.head<3>());
  return true;
}

Eigen::Vector3d Phantom::weight(const PhantomAngles& at, const Eigen::Vector3d& gravity) const noexcept {
  return -planarJacobian(moment2_, moment3_, at).transpose() * gravity;
}

Eigen::Vector3d Phantom::weight(const Eigen::Vector3d& q, const Eigen::Vector3d& gravity) const noexcept {
  return weight(PhantomAngles(q), gravity);
}

bool Phantom::gravity(const JointVector& q, const Eigen::Vector3d& gravity, JointVector& tau) const noexcept {
  tau = weight(q.head<3>(), gravity);
  return true;
}

std::span<const int32_t> Phantom::parents() const noexcept {
  static constexpr int32_t kParents[] = {-1, 0};
  return kParents;
}

Eigen::Vector3d Phantom::base() const noexcept {
  return geometry_.origin + Eigen::Vector3d(0, geometry_.l2, -geometry_.l1);
}

/// The angles of both links are absolute. The upper arm points along z of its frame, the forearm along -y of its frame.
bool Phantom::links(const JointVector& q, std::span<Pose> ends) const noexcept {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(q[0], Eigen::Vector3d::UnitY()));
  const auto raised = [&](double angle) {
    return turn * Eigen::Quaterniond(Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitX()));
  };
  ends[0].orientation = raised(q[1]);
  ends[0].position = base() + ends[0].orientation * Eigen::Vector3d(0, 0, geometry_.l1);
  ends[1].orientation = raised(q[2]);
  ends[1].position = ends[0].position + ends[1].orientation * Eigen::Vector3d(0, -geometry_.l2, 0);
  return true;
}

bool Phantom::allowed(const JointVector& q) const noexcept {
  return Arm::allowed(q) && q[2] - q[1] <= kOpening && q[1] - q[2] <= kClosing;
}

bool Phantom::inverse(const Eigen::Vector3d& position, JointVector& q) const noexcept {
  const Eigen::Vector3d p = position - geometry_.origin + Eigen::Vector3d(0, -geometry_.l2, geometry_.l1);
  const double l1 = geometry_.l1, l2 = geometry_.l2, out = std::hypot(p.x(), p.z()), h = p.y();
  const double turn = out > 0 ? std::atan2(p.x(), p.z()) : q[0];  // on the axis every turn is a solution, so q1 stays
  // |p|^2 = l1^2 + l2^2 + 2 l1 l2 sin(q3 - q2); the limits leave one branch of the arcsine.
  const double s = (out * out + h * h - l1 * l1 - l2 * l2) / (2 * l1 * l2);
  if (!(std::abs(s) <= 1)) return false;
  const double open = std::asin(s);
  const double elbow = std::atan2(-l2 * std::cos(open), l1 + l2 * s);
  JointVector best;
  double best_distance = HUGE_VAL;
  for (const int side : {1, -1}) {  // the tip is in front of the vertical axis, or the arm reaches over the axis
    JointVector candidate(3);
    candidate[0] = wrapped(side > 0 ? turn : turn + M_PI);
    candidate[2] = nearest(std::atan2(h, side * out) - elbow + open, M_PI / 2);
    candidate[1] = candidate[2] - open;
    const double distance = (candidate - q).norm();
    if (!allowed(candidate) || !(distance < best_distance)) continue;
    best = candidate;
    best_distance = distance;
  }
  if (best.size() == 0) return false;
  q = best;
  return true;
}

}  // namespace hapticd::kinematics
