// SPDX-License-Identifier: MIT
/// An arm whose base is turned and moved in the world: what it gives is in the world frame, and what reaches its motors
/// is the same wrench. An error here pushes the hand in a wrong direction.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "scene/load.hpp"
#include "servo/arm/arm.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Wrench = Eigen::Matrix<double, 6, 1>;
using Rows = double[6][HDV_MAX_JOINTS];

constexpr double kTick = 1.0 / 1500;
const Vector3d kBase(0.1, -0.2, 0.3);            ///< [m] the arm's base in the world
const Quaterniond kTurned(0.8, 0.2, -0.4, 0.4);  ///< its orientation: no axis stays where it was
const Vector3d kWeight(0, -9.81, 0);             ///< [m/s^2] gravity in the world

std::string sceneFile() {
  const auto folder = std::filesystem::temp_directory_path() / ("hapticd-mounted-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto file = folder / (::testing::UnitTest::GetInstance()->current_test_info()->name() + std::string(".yaml"));
  std::ofstream(file) << "hapticd: 1\nservo: {rate: 1500}\ndevice:\n  file: " HAPTICD_SOURCE_DIR
                         "/config/devices/simulated-sarcos.yaml\n"
                         "  mount: {position: [0.1, -0.2, 0.3], orientation: [0.8, 0.2, -0.4, 0.4]}\n"
                         "  hand: {script: guided, stiffness: 2000, damping: 50, tremor: 0, wander: 0}\n"
                         "models: []\n";
  return file;
}

/// The simulated arm of eight joints, in the pose in which it starts.
struct Mounted {
  Mounted() {
    host::Catalog catalog;
    scene::Loaded loaded = scene::load(sceneFile(), catalog);
    if (!loaded.scene) throw std::runtime_error(loaded.problems.front().text());
    loaded.scene->devices[0].limits.torque = 5;
    auto opened = Arm::open(loaded.scene->devices[0], loaded.scene->servo, {1500},
                            [](int, const std::string&, const std::string&) {});
    if (!opened) throw std::runtime_error(opened.error());
    arm = std::move(*opened);
    EXPECT_TRUE(arm->start(0, kWeight));
    EXPECT_TRUE(arm->read(0, 0).valid);
  }
  const hdv_ext_kinematics& kinematics() const { return arm->device().kinematics(); }
  hdv_device* handle() const { return arm->device().handle(); }
  Eigen::Index joints() const { return static_cast<Eigen::Index>(arm->info().joint_count); }
  Eigen::VectorXd angles() const { return Eigen::Map<const Eigen::VectorXd>(arm->sample().position, joints()); }

  /// The pose of the tip in the world for other joint angles.
  std::pair<Vector3d, Quaterniond> tipAt(const Eigen::VectorXd& q) const {
    Vector3d p;
    double turn[4];
    EXPECT_GE(kinematics().forward(handle(), q.data(), p.data(), turn), 0);
    return {kBase + kTurned * p, kTurned * Quaterniond(turn[0], turn[1], turn[2], turn[3])};
  }
  Eigen::MatrixXd jacobian() const {
    Rows rows;
    EXPECT_TRUE(arm->jacobian(rows));
    return Eigen::Map<Eigen::Matrix<double, 6, HDV_MAX_JOINTS, Eigen::RowMajor>>(&rows[0][0]).leftCols(joints());
  }
  /// Applies a wrench until every ramp is over, and returns the torques of the motors. The sample stays the same.
  Eigen::VectorXd torquesOf(const Wrench& wrench) {
    for (int i = 0; i < 3000; ++i) arm->write(0, kTick, wrench.head<3>(), wrench.tail<3>());
    EXPECT_EQ(arm->limiter().fault(), Fault::kNone);
    EXPECT_EQ(arm->command().mode, uint32_t{HDV_TORQUE});
    return Eigen::Map<const Eigen::VectorXd>(arm->command().torque, joints());
  }
  std::unique_ptr<Arm> arm;
};

TEST(MountedArm, ItsJacobianIsTheDerivativeOfItsTipInTheWorld) {
  const Mounted rig;
  const Eigen::MatrixXd J = rig.jacobian();
  constexpr double kStep = 1e-6;
  for (Eigen::Index joint = 0; joint < rig.joints(); ++joint) {
    Eigen::VectorXd more = rig.angles(), less = more;
    more[joint] += kStep, less[joint] -= kStep;
    const auto [p1, q1] = rig.tipAt(more);
    const auto [p0, q0] = rig.tipAt(less);
    EXPECT_LT((J.col(joint).head<3>() - (p1 - p0) / (2 * kStep)).norm(), 1e-8) << joint;
    const Quaterniond turn = q1 * q0.conjugate();
    const Vector3d rate = turn.vec() * std::copysign(1 / kStep, turn.w());
    EXPECT_LT((J.col(joint).tail<3>() - rate).norm(), 1e-8) << joint;
  }
}

TEST(MountedArm, ItsLastLinkEndsAtTheProbe) {
  const Mounted rig;
  std::array<Arm::LinkEnd, HDV_MAX_LINKS> ends;
  const uint32_t count = rig.arm->links(ends);
  ASSERT_EQ(count, rig.arm->linkCount());
  ASSERT_GT(count, 0u);
  const auto& [p, q] = ends[count - 1];
  const Probe& probe = rig.arm->probe();
  EXPECT_LT((Vector3d(p) - probe.position).norm(), 1e-12);
  EXPECT_LT(Quaterniond(q[0], q[1], q[2], q[3]).angularDistance(probe.orientation), 1e-7);
  const auto [tip, turn] = rig.tipAt(rig.angles());
  EXPECT_LT((tip - probe.position).norm(), 1e-12);
  EXPECT_LT(turn.angularDistance(probe.orientation), 1e-7);
}

TEST(MountedArm, ItsMotorsDoTheWorkOfTheWrench) {
  Mounted rig;
  Wrench wrench;
  wrench << 1, 2, -1, 0.1, -0.05, 0.02;
  const Eigen::VectorXd expected = rig.jacobian().transpose() * wrench;
  EXPECT_LT((rig.torquesOf(wrench) - expected).norm(), 1e-9 * expected.norm());
}

TEST(MountedArm, ItsMotorsHoldItAgainstTheGravityOfTheWorld) {
  Mounted rig;
  rig.arm->carryWeight(true);
  const Vector3d gravity_device = kTurned.conjugate() * kWeight;
  Eigen::VectorXd expected(rig.joints());
  ASSERT_EQ(rig.kinematics().gravity(rig.handle(), rig.angles().data(), gravity_device.data(), expected.data()),
            HSP_OK);
  ASSERT_GT(expected.norm(), 1);
  EXPECT_LT((rig.torquesOf(Wrench::Zero()) - expected).norm(), 1e-9 * expected.norm());
}

TEST(MountedArm, AProgramLeadsItsHandToAPlaceInTheWorld) {
  Mounted rig;
  const Vector3d wanted = rig.arm->probe().position + Vector3d(0.03, -0.02, 0.04);
  hapticd_target target{};
  Eigen::Map<Vector3d>(target.position) = wanted;
  target.orientation[0] = 1;
  link::PoseSlot slot;
  slot.put(target);
  ASSERT_TRUE(rig.arm->hand().guided());
  rig.arm->hand().begin(slot, rig.arm->probe().position);
  rig.arm->carryWeight(true);
  for (int i = 1; i < 4500; ++i) {
    const auto now = static_cast<Nanoseconds>(std::llround(i * kTick * 1e9));
    rig.arm->hand().step(i * kTick, kTick, 0);
    rig.arm->read(now, kTick);
    rig.arm->write(now, kTick, Vector3d::Zero(), Vector3d::Zero());
  }
  EXPECT_LT((rig.arm->probe().position - wanted).norm(), 0.01) << "but for the friction of its joints";
}

}  // namespace
}  // namespace hapticd::servo
