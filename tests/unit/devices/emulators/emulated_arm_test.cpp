// SPDX-License-Identifier: MIT
/// The shipped device files against arms whose wire format was written down a second time: a wall that the host makes
/// must hold a hand that presses into it. A wrong sign, scale or offset anywhere pushes the hand through instead.
#include "emulators/emulated_arm.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "emulators/wire_file.hpp"
#include "wire_arm/mechanism.hpp"
#include "wire_arm/session.hpp"

namespace hapticd::wire_arm {
namespace {

constexpr Nanoseconds kMs = 1'000'000;

struct Device {
  const char *file, *kind;
};

class ClosedLoop : public ::testing::TestWithParam<Device> {
 protected:
  ClosedLoop()
      : path(std::string(HAPTICD_SOURCE_DIR "/config/devices/") + GetParam().file),
        wire(codec::readWire(emulator::wireOf(path), 3)),
        mechanism(makeMechanism(parameters())),
        arm(GetParam().kind, softHand()) {}

  /// So soft that no motor reaches its limit.
  static simulated::Parameters softHand() {
    simulated::Parameters hand = emulator::defaultHand(GetParam().kind);
    hand.hand_stiffness = kHandStiffness;
    return hand;
  }
  static constexpr double kHandStiffness = 120;  ///< [N/m]

  MechanismParameters parameters() const {
    MechanismParameters p;
    for (const auto& value : YAML::LoadFile(path)["parameters"]["arm"]["lengths"])
      p.lengths.push_back(value.as<double>());
    return p;
  }

  Eigen::Vector3d tipOf(const JointArray& joints) const {
    kinematics::Pose tip;
    EXPECT_TRUE(mechanism->forward(Eigen::Map<const Eigen::Vector3d>(joints.data()), tip));
    return tip.position;
  }

  /// Two seconds of a hand that presses 30 mm deep; the host holds a wall of `stiffness` where the hand came from.
  /// @return deepest penetration [m]
  double press(double stiffness) {
    SessionSettings settings;
    settings.calibration = Calibration::kPose;
    Session session(wire, settings);
    Nanoseconds now = kMs;
    JointArray zero{};
    session.attach(now, zero, false);
    const Eigen::Vector3d start = arm.tip();
    kinematics::JointVector q = mechanism->neutral();
    EXPECT_TRUE(mechanism->inverse(start, q));
    double deepest = 0;
    ArmCommand wanted;
    for (int tick = 0; tick < 2000; ++tick, now += kMs) {
      std::array<uint8_t, 64> out{};
      arm.command({out.data(), session.command(now, wanted, out)});
      arm.advance(0.001);
      session.receive(now, arm.report());
      session.watch(now);
      if (tick == 0) {
        for (size_t i = 0; i < 3; ++i) zero[i] = q[static_cast<int>(i)] - session.raw()[i];
        session.setZero(zero);
        continue;
      }
      EXPECT_EQ(session.trouble(), Trouble::kNone) << describe(session.trouble()) << " at " << tick;
      const Eigen::Vector3d tip = tipOf(session.sample().position);
      EXPECT_LT((tip - arm.tip()).norm(), 1e-3);
      const double depth = start.z() - tip.z();
      deepest = std::max(deepest, depth);
      kinematics::Jacobian J;
      kinematics::JointVector joints = Eigen::Map<const Eigen::Vector3d>(session.sample().position.data());
      EXPECT_TRUE(mechanism->jacobian(joints, J));
      const Eigen::Vector3d tau = J.topRows<3>().transpose() * Eigen::Vector3d(0, 0, stiffness * std::max(0.0, depth));
      wanted.time = now, ++wanted.sequence, wanted.on = true;
      for (size_t i = 0; i < 3; ++i) wanted.torque[i] = tau[static_cast<int>(i)];
    }
    return deepest;
  }

  std::string path;
  codec::Wire wire;
  std::unique_ptr<kinematics::Arm> mechanism;
  emulator::EmulatedArm arm;
};

TEST_P(ClosedLoop, AWallHoldsTheHand) {
  const double deep = press(kHandStiffness);  // as stiff as the hand: half the way
  EXPECT_GT(deep, 0.005);
  EXPECT_LT(deep, 0.021);
}

TEST_P(ClosedLoop, WithoutAWallTheHandGoesWhereItWants) {
  EXPECT_GT(press(0), 0.025);
}

INSTANTIATE_TEST_SUITE_P(Shipped, ClosedLoop,
                         ::testing::Values(Device{"premium15.yaml", "premium15"},
                                           Device{"premium15-bulk.yaml", "premium15-bulk"},
                                           Device{"woodenhaptics.yaml", "woodenhaptics"},
                                           Device{"polhem.yaml", "polhem"}),
                         [](const auto& param) { return "Device" + std::to_string(param.index); });

/// A device file that ships without something that speaks its wire format is a guess that nobody tried.
TEST(DeviceFiles, EachHasAnEmulatorThatAnswersToItsId) {
  size_t on_usb = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HAPTICD_SOURCE_DIR "/config/devices")) {
    const YAML::Node file = YAML::LoadFile(entry.path().string());
    const std::string module = file["module"].as<std::string>(), name = entry.path().stem().string();
    if (module == "simulated") continue;
    if (module == "vme") {  // tests/emulators/vme plays the board of this one
      EXPECT_EQ(name, "sarcos");
      continue;
    }
    ++on_usb;
    ASSERT_NO_THROW(emulator::EmulatedArm(name, emulator::defaultHand(name))) << "no emulator for " << entry.path();
    const emulator::EmulatedArm arm(name, emulator::defaultHand(name));
    char id[16];
    std::snprintf(id, sizeof id, "%04x:%04x", arm.about().vendor, arm.about().product);
    EXPECT_EQ(file["parameters"]["usb"]["id"].as<std::string>(), id) << entry.path();
  }
  EXPECT_EQ(on_usb, emulator::emulatedKinds().size());
}

}  // namespace
}  // namespace hapticd::wire_arm
