// SPDX-License-Identifier: MIT
#include "simulated/parameters.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "kinematics/error_collector.hpp"
#include "kinematics/limit_order.hpp"
#include "simulated/mechanisms.hpp"

namespace hapticd::simulated {
namespace {

using Eigen::Vector3d;

/// Published figures of the Premium 1.5: gear ratios of its capstans, RE25 motors and HEDM-5500 encoders.
const Vector3d kPremiumGear(13.3, 11.2, 11.2);
constexpr double kPremiumCounts = 4096;     ///< counts per motor turn: 1024 lines with four edges each
constexpr double kPremiumStall = 0.129;     ///< [N m] stall torque of the motor
constexpr double kPremiumRotor = 1.08e-6;   ///< [kg m^2] inertia of the rotor
constexpr double kPremiumDamping = 0.0005;  ///< [N m s/rad] viscous friction of a joint
constexpr double kPremiumFriction = 0.01;   ///< [N m] Coulomb friction of a joint

Vector3d vector(const std::array<double, 3>& from) {
  return {from[0], from[1], from[2]};
}

/// Expands a list to one number per joint. The list has one number per joint, or one number for all joints; if it is
/// empty, `fallback` is used.
JointVector listOf(const std::vector<double>& from, int count, double fallback, const char* id) {
  if (from.empty()) return JointVector::Constant(count, fallback);
  if (from.size() == 1) return JointVector::Constant(count, from[0]);
  if (from.size() != static_cast<size_t>(count))
    throw std::invalid_argument(std::string(id) + ": " + std::to_string(from.size()) + " numbers, expected 1 or " +
                                std::to_string(count) + ", one per joint");
  return Eigen::Map<const JointVector>(from.data(), count);
}

/// Returns row `joint` of a list with `columns` numbers per joint, or nothing if the list is left out.
const double* rowOf(const std::vector<double>& from, size_t columns, size_t joint, size_t joints, const char* id) {
  if (from.empty()) return nullptr;
  if (from.size() != columns * joints)
    throw std::invalid_argument(std::string(id) + ": " + std::to_string(from.size() / columns) + " rows, expected " +
                                std::to_string(joints) + ": one for each row of arm.dh");
  return &from[columns * joint];
}

Eigen::Quaterniond baseOrientation(const std::vector<double>& q) {
  if (q.empty()) return Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond base(q.at(0), q.at(1), q.at(2), q.at(3));
  if (!(std::abs(base.norm() - 1) <= 1e-3))
    throw std::invalid_argument("arm.base_orientation: the quaternion has length " + std::to_string(base.norm()) +
                                ", expected a unit quaternion w, x, y, z (length 1)");
  return base.normalized();
}

}  // namespace

kinematics::ChainGeometry chainOf(const Parameters& p) {
  kinematics::ChainGeometry geometry;
  kinematics::ErrorCollector wrong;
  // Device files of real chains have arm.origin instead of arm.base_position.
  geometry.base.position = vector(p.base_position) + vector(p.origin);
  wrong.attempt([&] { geometry.base.orientation = baseOrientation(p.base_orientation); });
  geometry.tool.position = vector(p.tool_position);
  const size_t count = p.dh.size() / 4;
  kinematics::refuseReversedLimits(p.limits, wrong);
  if (count == 0) {
    wrong.add("arm.dh: has no rows, expected a row [a, alpha, d, theta] for each joint of a chain");
    wrong.check();
  }
  wrong.attempt([&] { (void)rowOf(p.limits, 2, 0, count, "arm.limits"); });
  wrong.attempt([&] { (void)rowOf(p.masses, 1, 0, count, "arm.masses"); });
  wrong.attempt([&] { (void)rowOf(p.centers, 3, 0, count, "arm.centers"); });
  wrong.attempt([&] { (void)rowOf(p.inertias, 3, 0, count, "arm.inertias"); });
  wrong.check();
  for (size_t i = 0; i < count; ++i) {
    kinematics::ChainLink link;
    link.a = p.dh[4 * i], link.alpha = p.dh[4 * i + 1], link.d = p.dh[4 * i + 2], link.theta = p.dh[4 * i + 3];
    if (const double* limit = rowOf(p.limits, 2, i, count, "arm.limits")) link.min = limit[0], link.max = limit[1];
    if (const double* mass = rowOf(p.masses, 1, i, count, "arm.masses")) link.mass = *mass;
    if (const double* center = rowOf(p.centers, 3, i, count, "arm.centers"))
      link.center = Vector3d(center[0], center[1], center[2]);
    if (const double* principal = rowOf(p.inertias, 3, i, count, "arm.inertias"))
      link.inertia = Vector3d(principal[0], principal[1], principal[2]).asDiagonal();
    geometry.links.push_back(link);
  }
  return geometry;
}

kinematics::PhantomGeometry phantomOf(const Parameters& p) {
  if (p.arm() == Kind::kPremium15) return kinematics::phantomGeometry({}, {}, vector(p.origin));
  return kinematics::phantomGeometry(p.lengths, p.masses, vector(p.origin));
}

kinematics::DeltaGeometry deltaOf(const Parameters& p) {
  kinematics::DeltaGeometry geometry;
  kinematics::ErrorCollector wrong;
  wrong.attempt([&] { geometry = kinematics::deltaGeometry(p.lengths, p.masses, p.angles); });
  wrong.attempt([&] { geometry.base.orientation = baseOrientation(p.base_orientation); });
  wrong.check();
  geometry.base.position = vector(p.origin);
  return geometry;
}

JointSettings jointsOf(const Parameters& p, int count) {
  const bool premium = p.arm() == Kind::kPremium15;
  kinematics::ErrorCollector wrong;
  const auto perJoint = [&](const std::vector<double>& values, double otherwise, const char* name) {
    JointVector list = JointVector::Ones(count);
    wrong.attempt([&] { list = listOf(values, count, otherwise, name); });
    return list;
  };
  JointVector gear = perJoint(p.gear, 1, "joint.gear");
  if (premium && p.gear.empty()) gear = kPremiumGear;
  JointSettings joints;
  const JointVector counts = perJoint(p.counts, premium ? kPremiumCounts : 0, "joint.counts");
  const JointVector rotor = perJoint(p.rotor, premium ? kPremiumRotor : 0, "joint.rotor");
  const JointVector torque = perJoint(p.max_torque, premium ? kPremiumStall : 100, "joint.max_torque");
  if (!p.arm_torque.empty() && !p.max_torque.empty())
    wrong.add("joint.max_torque: cannot be given together with arm.max_torque; remove one of the two");
  joints.step = joints.rotor = joints.max_torque = JointVector::Zero(count);
  for (int i = 0; i < count; ++i) {
    joints.step[i] = counts[i] > 0 ? 2 * M_PI / (counts[i] * gear[i]) : 0;
    joints.rotor[i] = rotor[i] * gear[i] * gear[i];
    joints.max_torque[i] = torque[i] * gear[i];
  }
  if (!p.arm_torque.empty()) joints.max_torque = perJoint(p.arm_torque, 0, "arm.max_torque");
  joints.damping = perJoint(p.damping, premium ? kPremiumDamping : 0, "joint.damping");
  joints.friction = perJoint(p.friction, premium ? kPremiumFriction : 0, "joint.friction");
  if (!p.stiffness.empty()) {
    joints.stiffness = perJoint(p.stiffness, 0, "joint.stiffness");
    joints.rate_damping = perJoint(p.rate_damping, 0, "joint.rate_damping");
  }
  wrong.check();
  joints.motor_lag = p.motor_lag;
  joints.friction_speed = p.friction_speed;
  return joints;
}

namespace {

/// Throws std::invalid_argument if a row of times ends before it begins.
void checkTimes(const std::vector<double>& times, const char* id) {
  for (size_t i = 0; i + 1 < times.size(); i += 2)
    if (!(times[i] < times[i + 1]))
      throw std::invalid_argument(std::string(id) + ": row " + std::to_string(i / 2 + 1) +
                                  " ends before it begins, expected rows [begin, end] in s, such as [[2, 4]]");
}

}  // namespace

HandSettings handOf(const Parameters& p) {
  HandSettings hand;
  hand.script = static_cast<Script>(p.script);
  hand.mass = p.mass, hand.stiffness = p.hand_stiffness, hand.damping = p.hand_damping;
  hand.center = vector(p.center), hand.normal = vector(p.normal), hand.axis = vector(p.axis);
  hand.radius = p.radius, hand.sweep = p.sweep, hand.rise = p.rise, hand.rate = p.hand_rate;
  hand.approach = p.approach, hand.lead_in = p.lead_in;
  hand.tremor = p.tremor, hand.wander = p.wander;
  hand.seed = static_cast<uint64_t>(p.seed);
  checkTimes(p.pressed, "hand.pressed");
  checkTimes(p.unplugged, "hand.unplugged");
  return hand;
}

namespace {

/// Returns an arm with the joint limits of the device file.
template <class Arm>
Arm limited(Arm arm, const Parameters& p) {
  if (p.limits.empty()) return arm;
  const auto rows = static_cast<Eigen::Index>(p.limits.size() / 2);
  kinematics::JointLimits limits{JointVector(rows), JointVector(rows)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    limits.min[i] = p.limits[static_cast<size_t>(2 * i)];
    limits.max[i] = p.limits[static_cast<size_t>(2 * i + 1)];
  }
  arm.narrow(limits);
  return arm;
}

kinematics::Phantom makePhantom(const Parameters& p) {
  return limited(kinematics::Phantom(phantomOf(p)), p);
}

kinematics::Delta makeDelta(const Parameters& p) {
  return limited(kinematics::Delta(deltaOf(p)), p);
}

kinematics::PhantomInertia inertiaOf(const Parameters& p, const JointVector& rotor) {
  constexpr size_t kNumbers = 15;
  kinematics::PhantomInertia inertia;
  inertia.rotor = rotor;
  if (p.arm() == Kind::kPremium15 || p.inertias.empty()) return inertia;
  const std::vector<double>& i = p.inertias;
  if (i.size() != kNumbers)
    throw std::invalid_argument("arm.inertias: " + std::to_string(i.size() / 3) +
                                " rows, expected 5 for a phantom: a, c, be, df and base");
  inertia.a = Vector3d(i[0], i[1], i[2]), inertia.c = Vector3d(i[3], i[4], i[5]);
  inertia.be = Vector3d(i[6], i[7], i[8]), inertia.df = Vector3d(i[9], i[10], i[11]);
  inertia.base_yy = i[13];
  return inertia;
}

}  // namespace

/// Refuses lists that this kind of arm would ignore, because it has its values from another list or has fixed ones.
static void refuseIdle(const Parameters& p, kinematics::ErrorCollector& wrong) {
  if (p.arm() == Kind::kChain && !p.lengths.empty())
    wrong.add("arm.lengths: a chain has its lengths in arm.dh; remove arm.lengths");
  if (p.arm() == Kind::kDelta && !p.inertias.empty())
    wrong.add("arm.inertias: a delta has those of its masses, and joint.rotor; remove arm.inertias");
  if (p.arm() != Kind::kPremium15) return;
  for (const auto& [list, name] : {std::pair{&p.lengths, "lengths"}, std::pair{&p.masses, "masses"},
                                   std::pair{&p.inertias, "inertias"}, std::pair{&p.limits, "limits"}})
    if (!list->empty())
      wrong.add(std::string("arm.") + name + ": a premium15 has fixed " + name +
                "; expected arm.kind phantom, or no arm." + name);
}

std::unique_ptr<kinematics::Arm> makeArm(const Parameters& p) {
  constexpr int kOfOthers = 3;  // phantom and delta
  kinematics::ErrorCollector wrong;
  std::unique_ptr<kinematics::Arm> arm;
  refuseIdle(p, wrong);
  wrong.attempt([&] {
    if (p.arm() == Kind::kChain)
      arm = std::make_unique<kinematics::Chain>(chainOf(p));
    else if (p.arm() == Kind::kDelta)
      arm = std::make_unique<kinematics::Delta>(makeDelta(p));
    else
      arm = std::make_unique<kinematics::Phantom>(makePhantom(p));
  });
  const int joints = p.arm() == Kind::kChain ? static_cast<int>(p.dh.size() / 4) : kOfOthers;
  if (joints > 0) wrong.attempt([&] { (void)jointsOf(p, joints); });
  wrong.check();
  return arm;
}

std::unique_ptr<Plant> makePlant(const Parameters& p, const JointSettings& joints, const Vector3d& gravity) {
  const double mass = static_cast<Script>(p.script) == Script::kNone ? 0 : p.mass;
  if (p.arm() == Kind::kChain)
    return std::make_unique<PlantOf<ChainMechanism>>(joints, ChainMechanism(chainOf(p), joints.rotor, mass, gravity));
  if (p.arm() == Kind::kDelta)
    return std::make_unique<PlantOf<DeltaMechanism>>(joints, DeltaMechanism(makeDelta(p), joints.rotor, mass, gravity));
  const kinematics::PhantomInertia inertia = inertiaOf(p, joints.rotor);
  return std::make_unique<PlantOf<PhantomMechanism>>(joints, PhantomMechanism(makePhantom(p), inertia, mass, gravity));
}

}  // namespace hapticd::simulated
