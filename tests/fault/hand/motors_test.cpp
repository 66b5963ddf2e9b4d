// SPDX-License-Identifier: MIT
/// A motor at its limit: the whole wrench becomes smaller, and points where it pointed.
#include <cmath>

#include "host/device_instance.hpp"
#include "scenario.hpp"
#include "shipped.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;
const auto kSilent = [](int, const std::string&, const std::string&) {};

/// The simulated Premium, in the belief that it may push with 100 N.
scene::Device strongPremium() {
  scene::Device device =
      shippedScene(
          "device: HERE/devices/simulated-premium15.yaml\nhand: {script: none}\nmodels:\n  - {name: s, plugin: "
          "nurbs_rigid, parameters: {geometry: HERE/models/sphere.yaml}}\n")
          .devices[0];
  const auto instance = host::DeviceInstance::create(device, kSilent);
  const hdv_class& module = (*instance)->description();
  for (uint32_t i = 0; i < module.param_count; ++i) {
    const hsp_param& param = *HSP_AT(const hsp_param, module.params, module.params[0].struct_size, i);
    if (std::string(param.id) != "device.max_force") continue;
    device.parameters.push_back(value(i, HSP_REAL, 100));
  }
  device.limits.force = 100;
  device.limits.slew = device.limits.ramp_in = 0;
  device.limits.weight = 0;
  return device;
}

TEST(Motors, KeepTheDirectionOfTheForceWhenOneIsAtItsLimit) {
  auto opened = Arm::open(strongPremium(), scene::Servo{}, {1000, false}, kSilent);
  ASSERT_TRUE(opened) << opened.error();
  Arm& arm = **opened;
  ASSERT_TRUE(arm.start(0, Vector3d::Zero()));
  int limited = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d force = 60 * Vector3d(std::sin(i), std::sin(2 * i + 1), std::cos(3 * i)).normalized();
    const Probe& probe = arm.read(static_cast<Nanoseconds>(i), 0);  // no time passes: the arm stands
    ASSERT_TRUE(probe.valid);
    arm.write(static_cast<Nanoseconds>(i), 1e-3, force, Vector3d::Zero());
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> J(6, 3);
    arm.device().kinematics().jacobian(arm.device().handle(), arm.sample().position, J.data());
    const Vector3d asked = J.topRows<3>().transpose() * force, sent(arm.command().torque);
    ASSERT_EQ(arm.command().mode, static_cast<uint32_t>(HDV_TORQUE));
    double largest = 0;
    for (uint32_t k = 0; k < 3; ++k) {
      ASSERT_LE(std::abs(sent[k]), arm.info().max_torque[k] * (1 + 1e-12));
      largest = std::max(largest, std::abs(sent[k]) / arm.info().max_torque[k]);
    }
    ASSERT_NEAR(sent.dot(asked) / (sent.norm() * asked.norm()), 1, 1e-9) << "it points where it pointed";
    limited += sent.norm() < asked.norm() * (1 - 1e-9) ? 1 : 0;
    if (sent.norm() < asked.norm() * (1 - 1e-9)) {
      ASSERT_NEAR(largest, 1, 1e-9) << "and one motor gives all that it can";
    }
  }
  EXPECT_GT(limited, 100) << "no motor was at its limit: no test";
  EXPECT_EQ(arm.limiter().clips().ticks[static_cast<size_t>(Limit::kMotors)], static_cast<uint64_t>(limited));
}

TEST(Motors, CarryTheWeightFirstAndPushWithWhatIsLeft) {
  scene::Device device = strongPremium();
  device.limits.weight.reset();
  auto opened = Arm::open(device, scene::Servo{}, {1000, false}, kSilent);
  ASSERT_TRUE(opened) << opened.error();
  Arm& arm = **opened;
  const Vector3d gravity(0, -9.81, 0);
  ASSERT_TRUE(arm.start(0, gravity));
  arm.carryWeight(true);
  int limited = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d force = 60 * Vector3d(std::sin(i), std::sin(2 * i + 1), std::cos(3 * i)).normalized();
    ASSERT_TRUE(arm.read(static_cast<Nanoseconds>(i), 0).valid);
    arm.write(static_cast<Nanoseconds>(i), 1e-3, force, Vector3d::Zero());
    const hdv_ext_kinematics& kinematics = arm.device().kinematics();
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> J(6, 3);
    kinematics.jacobian(arm.device().handle(), arm.sample().position, J.data());
    Vector3d weight;
    kinematics.gravity(arm.device().handle(), arm.sample().position, gravity.data(), weight.data());
    ASSERT_GT(weight.norm(), 1e-2) << "no weight: no test";
    const Vector3d asked = J.topRows<3>().transpose() * force, sent(arm.command().torque), pushed = sent - weight;
    const double share = pushed.dot(asked) / asked.squaredNorm();
    ASSERT_LE(share, 1 + 1e-9);
    ASSERT_LT((pushed - share * asked).norm(), 1e-9 * asked.norm()) << "the force points where it pointed";
    const Eigen::Array3d use = sent.array().abs() / Eigen::Map<const Eigen::Array3d>(arm.info().max_torque);
    ASSERT_LE(use.maxCoeff(), 1 + 1e-12);
    if (share > 1 - 1e-9) continue;
    ++limited;
    ASSERT_NEAR(use.maxCoeff(), 1, 1e-9) << "one motor gives all that it can";
  }
  EXPECT_GT(limited, 100) << "no motor was at its limit: no test";
}

}  // namespace
}  // namespace hapticd::servo
