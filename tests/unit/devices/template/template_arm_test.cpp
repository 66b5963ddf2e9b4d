// SPDX-License-Identifier: MIT
/// The module that authors copy keeps the promises of device.h: what is wrong here would be wrong in every copy.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hapticd/device.h"

namespace {

constexpr uint64_t kMillisecond = 1000000;
constexpr double kGravity = 9.81, kMass = 0.15, kHandStiffness = 300;

class TemplateArmTest : public ::testing::Test {
 protected:
  void SetUp() override {
    void* library = dlopen(TEMPLATE_ARM, RTLD_NOW | RTLD_LOCAL);
    const auto* entry = library ? static_cast<const hdv_entry*>(dlsym(library, "hdv_module_entry")) : nullptr;
    ASSERT_NE(entry, nullptr) << dlerror();
    class_ = entry->classes[0];
    device_ = class_->create(class_, nullptr);
    ASSERT_NE(device_, nullptr);
    kinematics_ = static_cast<const hdv_ext_kinematics*>(class_->extension(device_, HDV_EXT_KINEMATICS));
    cut_ = static_cast<const hdv_ext_cut*>(class_->extension(device_, HDV_EXT_CUT));
    ASSERT_NE(kinematics_, nullptr);
    ASSERT_NE(cut_, nullptr);
  }
  void TearDown() override {
    class_->close(device_);
    class_->destroy(device_);
  }
  void start() {
    info_.struct_size = sizeof info_;
    ASSERT_EQ(class_->open(device_, &info_), HSP_OK);
    hdv_start how{};
    how.struct_size = sizeof how;
    how.rate_hz = info_.rate_hz;
    how.time_ns = now_ns_;
    how.gravity[1] = -kGravity;
    ASSERT_EQ(class_->start(device_, &how), HSP_OK);
  }
  void write(uint32_t mode, double fx, double fy, double fz) {
    hdv_command command{};
    command.struct_size = sizeof command;
    command.mode = mode;
    command.torque[0] = fx, command.torque[1] = fy, command.torque[2] = fz;
    EXPECT_EQ(class_->write(device_, now_ns_, &command), HSP_OK);
  }
  const hdv_sample& read() {
    now_ns_ += kMillisecond;
    EXPECT_EQ(class_->read(device_, now_ns_, &sample_), HSP_OK);
    return sample_;
  }
  /// Where the carriage rests along x under a steady command: the hand does not move along x.
  double restingX(uint32_t mode, double fx) {
    for (int i = 0; i < 2000; ++i) {
      write(mode, fx, 0, 0);
      read();
    }
    return sample_.position[0];
  }

  const hdv_class* class_ = nullptr;
  hdv_device* device_ = nullptr;
  const hdv_ext_kinematics* kinematics_ = nullptr;
  const hdv_ext_cut* cut_ = nullptr;
  hdv_info info_{};
  hdv_sample sample_{};
  uint64_t now_ns_ = 5 * kMillisecond;
};

TEST_F(TemplateArmTest, ForceStretchesTheHandAsItsSpringSays) {
  start();
  EXPECT_NEAR(restingX(HDV_TORQUE, 3), 3 / kHandStiffness, 2e-5);
  EXPECT_NEAR(restingX(HDV_TORQUE, -1), -1 / kHandStiffness, 2e-5);
}

TEST_F(TemplateArmTest, CommandsAreBoundedAndOnesThatAreNotNumbersPushNowhere) {
  start();
  EXPECT_NEAR(restingX(HDV_TORQUE, 1000), info_.max_torque[0] / kHandStiffness, 2e-5);
  EXPECT_NEAR(restingX(HDV_TORQUE, NAN), 0, 2e-5);
}

TEST_F(TemplateArmTest, OffMeansFreeWhateverTheNumbersSay) {
  start();
  EXPECT_NEAR(restingX(HDV_OFF, 5), 0, 2e-5);
}

TEST_F(TemplateArmTest, ACutStaysUntilACommandSaysOff) {
  start();
  EXPECT_GT(restingX(HDV_TORQUE, 3), 0.009);
  cut_->cut(device_);
  EXPECT_NEAR(restingX(HDV_TORQUE, 3), 0, 2e-5);
  write(HDV_OFF, 0, 0, 0);
  EXPECT_NEAR(restingX(HDV_TORQUE, 3), 3 / kHandStiffness, 2e-5);
}

TEST_F(TemplateArmTest, ACutFreesTheMotorsWithoutAnotherCommand) {
  start();
  EXPECT_GT(restingX(HDV_TORQUE, 3), 0.009);
  cut_->cut(device_);
  for (int i = 0; i < 2000; ++i) read();  // the thread that writes is stuck
  EXPECT_NEAR(sample_.position[0], 0, 2e-5);
}

TEST_F(TemplateArmTest, JacobianIsTheDerivativeOfForward) {
  const double q[3] = {0.02, -0.03, 0.05}, h = 1e-6;
  double J[18];
  ASSERT_EQ(kinematics_->jacobian(device_, q, J), HSP_OK);
  for (int joint = 0; joint < 3; ++joint) {
    double ahead[3] = {q[0], q[1], q[2]}, p0[3], p1[3], turned[4];
    ahead[joint] += h;
    ASSERT_EQ(kinematics_->forward(device_, q, p0, turned), HSP_OK);
    ASSERT_EQ(kinematics_->forward(device_, ahead, p1, turned), HSP_OK);
    for (int row = 0; row < 3; ++row) EXPECT_NEAR(J[row * 3 + joint], (p1[row] - p0[row]) / h, 1e-9);
    for (int row = 3; row < 6; ++row) EXPECT_EQ(J[row * 3 + joint], 0);
  }
}

TEST_F(TemplateArmTest, InverseFindsTheJointsOfAPositionAndRefusesWhatIsOutOfReach) {
  const double target[3] = {0.1, -0.1, 0.149}, far[3] = {0.2, 0, 0}, nowhere[3] = {NAN, 0, 0};
  double q[3] = {}, p[3], turned[4];
  ASSERT_EQ(kinematics_->inverse(device_, target, q), HSP_OK);
  ASSERT_EQ(kinematics_->forward(device_, q, p, turned), HSP_OK);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(p[i], target[i], 1e-12);
  EXPECT_EQ(kinematics_->inverse(device_, far, q), HSP_E_NUMERIC);
  EXPECT_EQ(kinematics_->inverse(device_, nowhere, q), HSP_E_NUMERIC);
}

TEST_F(TemplateArmTest, TheWeightItTellsLiftsTheCarriage) {
  start();
  const auto restingY = [&](double fy) {
    double sum = 0;
    for (int i = 0; i < 4000; ++i) {  // two strokes of the hand
      write(HDV_TORQUE, 0, fy, 0);
      sum += read().position[1];
    }
    return sum / 4000;
  };
  const double q[3] = {}, gravity[3] = {0, -kGravity, 0};
  double tau[3];
  ASSERT_EQ(kinematics_->gravity(device_, q, gravity, tau), HSP_OK);
  EXPECT_NEAR(tau[1], kMass * kGravity, 1e-12);
  (void)restingY(0);
  const double sagging = restingY(0);
  (void)restingY(tau[1]);
  EXPECT_NEAR(restingY(tau[1]) - sagging, kMass * kGravity / kHandStiffness, 2e-5);
}

TEST_F(TemplateArmTest, EachNewTimeIsANewSampleAndTheSameTimeIsNot) {
  start();
  const uint64_t first = read().sequence, second = read().sequence;
  EXPECT_GT(second, first);
  ASSERT_EQ(class_->read(device_, now_ns_, &sample_), HSP_OK);
  EXPECT_EQ(sample_.sequence, second);
}

TEST_F(TemplateArmTest, NothingIsReadBeforeItIsStarted) {
  EXPECT_EQ(class_->read(device_, now_ns_, &sample_), HSP_E_STATE);
}

}  // namespace
