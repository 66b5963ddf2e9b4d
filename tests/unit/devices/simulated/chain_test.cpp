// SPDX-License-Identifier: MIT
/// A serial arm with torque sensors and its own position loop.
#include "module.hpp"

namespace hapticd::simulated {
namespace {

using Eigen::Vector3d;

/// A chain of three joints with sensors and its own position loop.
void describeChain(Module& arm) {
  arm.set("arm.kind", 1);
  arm.set("arm.dh", std::vector<double>{0, M_PI / 2, 0.1, 0, 0.3, 0, 0, 0.5, 0.25, 0, 0, -1});
  arm.set("arm.masses", std::vector<double>{1, 1, 0.5});
  arm.set("arm.centers", std::vector<double>{0, 0, 0, -0.15, 0, 0, -0.1, 0, 0});
  arm.set("arm.inertias", std::vector<double>{0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.005, 0.005, 0.005});
  arm.set("arm.limits", std::vector<double>{-2, 2, -1, 1.5, -1.2, 1.2});
  arm.set("joint.damping", std::vector<double>{0.1});
  arm.set("joint.stiffness", std::vector<double>{2000});
  arm.set("joint.rate_damping", std::vector<double>{40});
  arm.set("joint.torque_sensors", 1);
  arm.set("hand.script", kNone);
}

TEST(SimulatedChain, MeasuresTheForceThatTheHandPushesWith) {
  Module arm;
  describeChain(arm);
  arm.set("hand.script", kHold), arm.set("hand.radius", 0.0), arm.set("hand.approach", 0.0);
  arm.set("hand.center", std::vector<double>{0.4, 0.05, 0.2}), arm.set("hand.stiffness", 500);
  ASSERT_EQ(arm.start(), HSP_OK) << arm.said;
  const Vector3d force(2, -1, 1.5);
  for (int i = 0; i < 4000; ++i) {
    arm.read(kMillisecond);
    arm.write(HDV_TORQUE, arm.torqueOf(force));
  }
  EXPECT_TRUE((arm.info.capabilities & HDV_C_TORQUE) != 0 && (arm.sample.flags & HDV_S_TORQUE) != 0);
  const Eigen::VectorXd measured = Eigen::Map<const Eigen::VectorXd>(arm.sample.torque, 3);
  EXPECT_LT((measured - arm.torqueOf(force)).norm(), 1e-3);
  const Vector3d center(0.4, 0.05, 0.2);
  EXPECT_LT((arm.tip() - center - force / 500).norm(), 1e-4);
}

TEST(SimulatedChain, FollowsAMovingReferenceWithoutTheLagOfItsDamping) {
  Module arm;
  describeChain(arm);
  ASSERT_EQ(arm.start(), HSP_OK) << arm.said;
  arm.read(kMillisecond);
  Eigen::VectorXd wanted = arm.joints();
  for (int i = 0; i < 1000; ++i) {
    wanted += Eigen::Vector3d::Constant(0.2e-3);  // 0.2 rad/s; against standing still the damping would lag by 4 mrad
    hdv_command command{};
    command.struct_size = sizeof command;
    command.mode = HDV_POSITION;
    const Eigen::VectorXd weight = arm.torqueOf(Vector3d::Zero());
    for (int j = 0; j < 3; ++j) command.position[j] = wanted[j], command.torque[j] = weight[j];
    arm.write(command);
    arm.read(kMillisecond);
  }
  EXPECT_LT((arm.joints() - wanted).norm(), 5e-4);
}

TEST(SimulatedChain, HoldsAPositionReference) {
  Module arm;
  describeChain(arm);
  ASSERT_EQ(arm.start(), HSP_OK) << arm.said;
  EXPECT_NE(arm.info.capabilities & HDV_C_POSITION, 0u);
  const Vector3d wanted(0.3, 0.2, -0.1);
  for (int i = 0; i < 3000; ++i) {
    arm.read(kMillisecond);
    hdv_command command{};
    command.struct_size = sizeof command;
    command.mode = HDV_POSITION;
    const Eigen::VectorXd weight = arm.torqueOf(Vector3d::Zero());
    for (int j = 0; j < 3; ++j) command.position[j] = wanted[j], command.torque[j] = weight[j];
    arm.write(command);
  }
  EXPECT_LT((arm.joints() - wanted).norm(), 1e-4);
}

}  // namespace
}  // namespace hapticd::simulated
