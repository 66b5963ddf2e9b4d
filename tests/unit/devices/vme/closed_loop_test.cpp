// SPDX-License-Identifier: MIT
/// A hand that strokes a cylinder through the board: the host's side uses the shipped device file alone, so a wrong
/// sign, scale, offset or kinematic length anywhere lets the hand through or throws it off. The same loop around the
/// simulated arm itself is the measure.
#include "rig.hpp"

namespace hapticd::vme {
namespace {

using Eigen::Vector3d;
constexpr double kRadius = 0.04;     ///< [m] of a cylinder about y
constexpr double kStiffness = 4000;  ///< [N/m]
constexpr int kSettled = 1500;       ///< ticks

struct Contact {
  double deepest = 0, sum = 0, force = 0;
  int ticks = 0;
  double mean() const { return ticks > 0 ? sum / ticks : 0; }
};

/// Force of the cylinder on the tip; books the contact.
Vector3d push(const Vector3d& tip, int tick, Contact& contact) {
  const Vector3d out(tip.x(), 0, tip.z());
  const double depth = kRadius - out.norm();
  if (depth <= 0) return Vector3d::Zero();
  if (tick > kSettled) {
    ++contact.ticks;
    contact.sum += depth;
    contact.deepest = std::max(contact.deepest, depth);
    contact.force = std::max(contact.force, kStiffness * depth);
  }
  return kStiffness * depth * out.normalized();
}

/// Torques of a force at the tip, and of the arm's weight.
kinematics::JointVector torques(const kinematics::Arm& arm, const kinematics::JointVector& q, const Vector3d& force) {
  kinematics::Jacobian J;
  kinematics::JointVector weight;
  EXPECT_TRUE(arm.jacobian(q, J));
  EXPECT_TRUE(arm.gravity(q, Vector3d(0, -9.81, 0), weight));
  kinematics::Wrench W = kinematics::Wrench::Zero();
  W.head<3>() = force;
  return J.transpose() * W + weight;
}

Contact throughTheBoard(double seconds) {
  Rig rig("closed-loop");
  const auto arm = mechanismOf(kSarcos);
  EXPECT_EQ(arm->jointCount(), 10);
  Contact contact;
  int tick = 0;
  uint64_t seen = 0;
  kinematics::JointVector tau = kinematics::JointVector::Zero(10);
  rig.want = [&](const wire_arm::Sample& sample, wire_arm::ArmCommand& wanted) {
    if (sample.sequence != seen) {
      seen = sample.sequence;
      const kinematics::JointVector q = Eigen::Map<const kinematics::JointVector>(sample.position.data(), 10);
      kinematics::Pose tip;
      EXPECT_TRUE(arm->forward(q, tip));
      tau = torques(*arm, q, push(tip.position, tick++, contact));
    }
    for (size_t i = 0; i < 10; ++i) wanted.torque[i] = tau[static_cast<int>(i)];
  };
  rig.run(seconds);
  EXPECT_EQ(rig.session.trouble(), wire_arm::Trouble::kNone) << describe(rig.session.trouble());
  EXPECT_TRUE(rig.board.pushed());
  return contact;
}

Contact direct(double seconds) {
  host::Catalog catalog = builtModules();
  emulator::VmeBoard board(kSimulated, catalog);  // for its arm alone
  host::DeviceInstance& device = board.arm();
  const auto arm = mechanismOf(kSimulated);
  EXPECT_EQ(arm->jointCount(), 8);
  Contact contact;
  hdv_sample sample{};
  for (int tick = 0; tick < static_cast<int>(seconds * 1500); ++tick) {
    const auto now = uint64_t{1} + static_cast<uint64_t>(tick) * 666'666;
    device.read(now, sample);
    const kinematics::JointVector q = Eigen::Map<const kinematics::JointVector>(sample.position, 8);
    kinematics::Pose tip;
    EXPECT_TRUE(arm->forward(q, tip));
    const kinematics::JointVector tau = torques(*arm, q, push(tip.position, tick, contact));
    hdv_command command{};
    command.struct_size = sizeof command;
    command.mode = HDV_TORQUE;
    for (int i = 0; i < 8; ++i) command.torque[i] = tau[i];
    device.write(now, command);
  }
  return contact;
}

TEST(VmeClosedLoop, ContactIsAsOfTheSimulatedArmItself) {
  const Contact measure = direct(6), found = throughTheBoard(6);
  ASSERT_GT(measure.ticks, 3000);
  EXPECT_NEAR(found.ticks, measure.ticks, 0.15 * measure.ticks);
  EXPECT_NEAR(found.mean(), measure.mean(), 0.2 * measure.mean());
  EXPECT_LT(found.deepest, 1.5 * measure.deepest);
  EXPECT_GT(found.deepest, 0.67 * measure.deepest);
  RecordProperty("mean_depth_um", static_cast<int>(1e6 * found.mean()));
  RecordProperty("direct_mean_depth_um", static_cast<int>(1e6 * measure.mean()));
}

TEST(VmeClosedLoop, OnReferencesTheArmStandsWhereItIsTold) {
  Rig rig("follow");
  wire_arm::JointArray target{};
  bool have = false;
  const auto arm = mechanismOf(kSarcos);
  rig.want = [&](const wire_arm::Sample& sample, wire_arm::ArmCommand& wanted) {
    if (!have && sample.calibrated) target = sample.position, target[0] += 0.05, target[3] -= 0.05, have = true;
    const kinematics::JointVector q = Eigen::Map<const kinematics::JointVector>(sample.position.data(), 10);
    const kinematics::JointVector weight = torques(*arm, q, Vector3d::Zero());
    wanted.follow = have;
    wanted.position = target;
    for (size_t i = 0; i < 10; ++i) wanted.torque[i] = weight[static_cast<int>(i)];
  };
  rig.run(2);
  ASSERT_TRUE(have);
  EXPECT_TRUE(rig.board.followed());
  for (size_t i : {0u, 3u}) EXPECT_NEAR(rig.session.sample().position[i], target[i], 0.01) << i;
}

}  // namespace
}  // namespace hapticd::vme
