// SPDX-License-Identifier: MIT
#include "wire_arm/mechanism.hpp"

#include <stdexcept>
#include <string>

#include "kinematics/carried_bodies.hpp"
#include "kinematics/chain.hpp"
#include "kinematics/delta.hpp"
#include "kinematics/error_collector.hpp"
#include "kinematics/limit_order.hpp"
#include "kinematics/phantom.hpp"

namespace hapticd::wire_arm {
namespace {

using Eigen::Vector3d;

kinematics::Pose baseOf(const MechanismParameters& p) {
  kinematics::Pose base;
  base.position = Vector3d(p.origin[0], p.origin[1], p.origin[2]);
  if (p.base_orientation.empty()) return base;
  const auto& q = p.base_orientation;
  base.orientation = Eigen::Quaterniond(q.at(0), q.at(1), q.at(2), q.at(3));
  if (!(std::abs(base.orientation.norm() - 1) <= 1e-3))
    throw std::invalid_argument("arm.base_orientation: the quaternion has length " +
                                std::to_string(base.orientation.norm()) +
                                ", expected a unit quaternion w, x, y, z (length 1)");
  base.orientation.normalize();
  return base;
}

std::unique_ptr<kinematics::Arm> phantom(const MechanismParameters& p) {
  const Vector3d origin(p.origin[0], p.origin[1], p.origin[2]);
  return std::make_unique<kinematics::Phantom>(kinematics::phantomGeometry(p.lengths, p.masses, origin));
}

std::unique_ptr<kinematics::Arm> delta(const MechanismParameters& p) {
  kinematics::DeltaGeometry g;
  kinematics::ErrorCollector wrong;
  wrong.attempt([&] { g = kinematics::deltaGeometry(p.lengths, p.masses, p.angles); });
  wrong.attempt([&] { g.base = baseOf(p); });
  wrong.check();
  return std::make_unique<kinematics::Delta>(g);
}

void needRows(const std::vector<double>& list, size_t columns, size_t rows, const char* id, const char* why) {
  if (list.empty() || list.size() == columns * rows) return;
  const size_t given = list.size() / columns;
  const std::string noun = columns > 1 ? "row" : "number";
  throw std::invalid_argument(std::string(id) + ": " + std::to_string(given) + " " + noun + (given == 1 ? "" : "s") +
                              ", expected " + std::to_string(rows) + ": " + why);
}

std::unique_ptr<kinematics::Arm> chain(const MechanismParameters& p) {
  kinematics::ChainGeometry g;
  kinematics::ErrorCollector wrong;
  wrong.attempt([&] { g.base = baseOf(p); });
  g.tool.position = Vector3d(p.tool_position[0], p.tool_position[1], p.tool_position[2]);
  const size_t count = p.dh.size() / 4, all = count + static_cast<size_t>(p.others);
  kinematics::refuseReversedLimits(p.limits, wrong);
  if (count == 0) {
    wrong.add("arm.dh: has no rows, expected a row [a, alpha, d, theta] for each joint of a chain");
    wrong.check();
  }
  wrong.attempt(
      [&] { needRows(p.limits, 2, all, "arm.limits", "one for each row of arm.dh and each joint of arm.others"); });
  wrong.attempt([&] { needRows(p.masses, 1, count, "arm.masses", "one for each row of arm.dh"); });
  wrong.attempt([&] { needRows(p.centers, 3, count, "arm.centers", "one for each row of arm.dh"); });
  wrong.check();
  for (size_t i = 0; i < count; ++i) {
    kinematics::ChainLink link;
    link.a = p.dh[4 * i], link.alpha = p.dh[4 * i + 1], link.d = p.dh[4 * i + 2], link.theta = p.dh[4 * i + 3];
    if (!p.limits.empty()) link.min = p.limits[2 * i], link.max = p.limits[2 * i + 1];
    if (!p.masses.empty()) link.mass = p.masses[i];
    if (!p.centers.empty()) link.center = Vector3d(p.centers[3 * i], p.centers[3 * i + 1], p.centers[3 * i + 2]);
    g.links.push_back(link);
  }
  auto arm = std::make_unique<kinematics::Chain>(g);
  if (p.others == 0) return arm;
  kinematics::JointLimits others{kinematics::JointVector::Constant(p.others, -M_PI),
                                 kinematics::JointVector::Constant(p.others, M_PI)};
  for (size_t i = count; i < all && !p.limits.empty(); ++i) {
    others.min[static_cast<int>(i - count)] = p.limits[2 * i];
    others.max[static_cast<int>(i - count)] = p.limits[2 * i + 1];
  }
  return std::make_unique<kinematics::CarriedBodies>(std::move(arm), others);
}

std::unique_ptr<kinematics::Arm> mechanism(const MechanismParameters& p) {
  switch (static_cast<Kind>(p.kind)) {
    case Kind::kPhantom:
      return phantom(p);
    case Kind::kDelta:
      return delta(p);
    case Kind::kChain:
      return chain(p);
  }
  return nullptr;
}

}  // namespace

size_t jointsOf(const MechanismParameters& p) {
  constexpr size_t kOfOthers = 3;  // phantom and delta
  if (static_cast<Kind>(p.kind) != Kind::kChain) return kOfOthers;
  if (p.dh.empty()) return p.limits.size() / 2;  // a mistake, but arm.limits may tell how many joints were meant
  return p.dh.size() / 4 + static_cast<size_t>(p.others);
}

std::unique_ptr<kinematics::Arm> makeMechanism(const MechanismParameters& p) {
  if (p.limits.empty() || static_cast<Kind>(p.kind) == Kind::kChain) return mechanism(p);
  kinematics::ErrorCollector wrong;
  std::unique_ptr<kinematics::Arm> arm;
  wrong.attempt([&] { arm = mechanism(p); });
  wrong.attempt([&] { needRows(p.limits, 2, jointsOf(p), "arm.limits", "one for each joint"); });
  kinematics::refuseReversedLimits(p.limits, wrong);
  wrong.check();
  const auto rows = static_cast<Eigen::Index>(p.limits.size() / 2);
  kinematics::JointLimits limits{kinematics::JointVector(rows), kinematics::JointVector(rows)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    limits.min[i] = p.limits[static_cast<size_t>(2 * i)];
    limits.max[i] = p.limits[static_cast<size_t>(2 * i + 1)];
  }
  arm->narrow(limits);
  return arm;
}

}  // namespace hapticd::wire_arm
