// SPDX-License-Identifier: MIT
/// Kinematics of the shipped Sarcos description: the thumb takes no part, and going there and back again ends where it
/// began. Eight joints for a point are too many: "back" means the tip, the joints may be others.
#include <fstream>
#include <random>

#include "rig.hpp"
#include "scene/load.hpp"

namespace hapticd::vme {
namespace {

using kinematics::JointVector;

JointVector randomJoints(const kinematics::Arm& arm, std::mt19937_64& random, double part) {
  std::uniform_real_distribution<double> place(0.5 - 0.5 * part, 0.5 + 0.5 * part);
  JointVector q(arm.jointCount());
  for (Eigen::Index i = 0; i < q.size(); ++i)
    q[i] = arm.limits().min[i] + place(random) * (arm.limits().max[i] - arm.limits().min[i]);
  return q;
}

TEST(SarcosKinematics, ForwardThenInverseThenForwardIsTheSameTipWithinAPicometre) {
  const auto arm = mechanismOf(kSarcos);
  std::mt19937_64 random(7);
  double worst = 0;
  for (int i = 0; i < 500; ++i) {
    const JointVector q = randomJoints(*arm, random, 0.95);
    kinematics::Pose there, back;
    ASSERT_TRUE(arm->forward(q, there));
    JointVector found = arm->neutral();
    ASSERT_TRUE(arm->inverse(there.position, found)) << "pose " << i << ": " << q.transpose();
    ASSERT_TRUE(arm->allowed(found));
    ASSERT_TRUE(arm->forward(found, back));
    worst = std::max(worst, (back.position - there.position).norm());
    EXPECT_EQ(found.tail(2), arm->neutral().tail(2)) << "the thumb stays where it is";
  }
  EXPECT_LE(worst, 1e-12);
}

TEST(SarcosKinematics, TheThumbMovesNoTipAndHasNoWeight) {
  const auto arm = mechanismOf(kSarcos);
  std::mt19937_64 random(8);
  for (int i = 0; i < 100; ++i) {
    const JointVector q = randomJoints(*arm, random, 1);
    kinematics::Jacobian J;
    ASSERT_TRUE(arm->jacobian(q, J));
    ASSERT_EQ(J.cols(), 10);
    EXPECT_TRUE(J.rightCols<2>().isZero(0));
    constexpr double h = 1e-6;
    for (int j = 0; j < 10; ++j) {  // J against forward(), by differences
      JointVector plus = q, minus = q;
      plus[j] += h, minus[j] -= h;
      kinematics::Pose a, b;
      ASSERT_TRUE(arm->forward(plus, a) && arm->forward(minus, b));
      EXPECT_LE((J.col(j).head<3>() - (a.position - b.position) / (2 * h)).norm(), 1e-9);
    }
    JointVector weight;
    ASSERT_TRUE(arm->gravity(q, Eigen::Vector3d(0, -9.81, 0), weight));
    EXPECT_TRUE(weight.tail(2).isZero(0));
  }
}

TEST(SarcosKinematics, ItIsTheSimulatedArmWithAThumb) {
  const auto arm = mechanismOf(kSarcos), simulated = mechanismOf(kSimulated);
  std::mt19937_64 random(9);
  for (int i = 0; i < 50; ++i) {
    const JointVector q = randomJoints(*arm, random, 1);
    kinematics::Pose a, b;
    JointVector wa, wb;
    ASSERT_TRUE(arm->forward(q, a) && simulated->forward(q.head(8), b));
    EXPECT_EQ(a.position, b.position);
    ASSERT_TRUE(arm->gravity(q, Eigen::Vector3d(0, -9.81, 0), wa));
    ASSERT_TRUE(simulated->gravity(q.head(8), Eigen::Vector3d(0, -9.81, 0), wb));
    EXPECT_LE((wa.head(8) - wb).norm(), 1e-12);
  }
}

/// Opens the shipped arm over a plain file, after a change of its device file.
std::unique_ptr<host::DeviceInstance> openChanged(const WindowFile& window, const std::string& from,
                                                  const std::string& to) {
  std::ifstream in(kSarcos);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  for (const auto& [old, now] : {std::pair<std::string, std::string>{"/dev/bus/vme/m0", window.path()}, {from, to}})
    text.replace(text.find(old), old.size(), now);
  const std::string file = window.path() + ".yaml";
  std::ofstream(file) << text;
  host::Catalog catalog = builtModules();
  const auto loaded = scene::loadDevice(file, catalog);
  std::filesystem::remove(file);
  if (!loaded.device) throw std::runtime_error(loaded.problems.front().text());
  auto arm = host::DeviceInstance::create(*loaded.device, [](int, const std::string&, const std::string&) {});
  if (!arm || !(*arm)->open()) throw std::runtime_error("cannot be opened");
  return std::move(*arm);
}

TEST(Sarcos, NamesNoLargerTorqueThanItsCommandsCanHave) {
  const WindowFile window("torque");
  const std::string field = "- {is: torque, joint: 2, at: 14, type: i16, endian: big, scale: 0.005";
  EXPECT_DOUBLE_EQ(openChanged(window, field, field)->info().max_torque[1], 95) << "as its file says";
  // A torque that is cut off on the wire would turn the force on the hand.
  EXPECT_NEAR(openChanged(window, field, field + ", limit: 4000")->info().max_torque[1], 20, 1e-9);
  EXPECT_NEAR(openChanged(window, field, field + ", offset: 100")->info().max_torque[1], 32768 * 0.005 - 100, 1e-9);
}

}  // namespace
}  // namespace hapticd::vme
