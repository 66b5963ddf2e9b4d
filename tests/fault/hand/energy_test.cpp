// SPDX-License-Identifier: MIT
/// Energy, not only time: what any single fault gives to an arm that nobody holds. The commands of a run with 8.5 N and
/// a fault move the simulated Premium, which was at rest and free until then: as if the hand let go at that moment.
#include <cmath>
#include <cstdio>

#include "host/device_instance.hpp"
#include "scenario.hpp"
#include "shipped.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

constexpr double kAt = 0.2, kMostEnergy = 5e-3, kMostWay = 1e-3;
constexpr double kFelt = 0.02;  // [N] less does not push: the last bit of a force that fades

/// The simulated Premium 1.5 without a hand, its weight carried.
class FreePremium {
 public:
  FreePremium() {
    const scene::Scene scene = shippedScene(
        "device: HERE/devices/simulated-premium15.yaml\nhand: {script: none}\nmodels:\n  - {name: s, plugin: "
        "nurbs_rigid, parameters: {geometry: HERE/models/sphere.yaml}}\n");
    auto made = host::DeviceInstance::create(scene.devices[0], [](int, const std::string&, const std::string&) {});
    if (!made) throw std::runtime_error(made.error());
    device_ = std::move(*made);
    hdv_start how{};
    how.struct_size = sizeof how;
    how.rate_hz = 1000;
    if (!device_->open() || !device_->start(how)) throw std::runtime_error("the simulated Premium does not start");
    read();
    begun_ = tip_;
  }

  /// Holds a force [N] at the tip for a time [s].
  void push(const Vector3d& force, double seconds) {
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> J(6, 3);
    device_->kinematics().jacobian(device_->handle(), sample_.position, J.data());
    hdv_command command{};
    command.struct_size = sizeof command;
    command.mode = HDV_TORQUE;
    Eigen::Map<Vector3d>(command.torque) = J.topRows<3>().transpose() * force;
    (void)device_->write(now_ns_, command);
    const Vector3d before = tip_;
    now_ns_ += static_cast<uint64_t>(std::llround(seconds * 1e9));
    read();
    energy_ += force.dot(tip_ - before);
    if (force.norm() > kFelt) way_ = (tip_ - begun_).norm();
  }

  double energy() const { return energy_; }                 ///< [J] that the motors gave
  double way() const { return way_; }                       ///< [m] while they pushed
  double travel() const { return (tip_ - begun_).norm(); }  ///< [m] until now

 private:
  void read() {
    (void)device_->read(now_ns_, sample_);
    double velocity[3], force[3];
    device_->hand()->truth(device_->handle(), tip_.data(), velocity, force);
  }

  std::unique_ptr<host::DeviceInstance> device_;
  hdv_sample sample_{};
  uint64_t now_ns_ = 0;
  Vector3d tip_ = Vector3d::Zero(), begun_ = Vector3d::Zero();
  double energy_ = 0, way_ = 0;
};

/// A single fault: what is done to the arm from kAt on, or by the plugin.
struct Single {
  const char* name;
  void (*inject)(rig::Wishes&);
  int plugin = 0;  ///< `how` of the shape `failing`
  double rate = 1000;
  double arm_rate = 1000;  ///< that the arm names
  /// [s] How long before the tick that finds it, it may have begun; a sample that does not come is late only once it is
  /// due.
  double since() const { return rate < 1000 ? 1 / rate : arm_rate < 1000 ? 1 / rate - 1 / arm_rate : 0; }
  bool slow() const { return rate < 358 || arm_rate < 715; }
};

const Single kSingle[] = {
    {"device_lost", [](rig::Wishes& w) { w.faults = rig::kLost; }},
    {"hardware_fault", [](rig::Wishes& w) { w.faults = rig::kHardwareFault; }},
    {"silent", [](rig::Wishes& w) { w.faults = rig::kSilent; }},
    {"write_fails", [](rig::Wishes& w) { w.faults = rig::kWriteFails; }},
    {"not_a_number", [](rig::Wishes& w) { w.position[0] = std::nan(""); }},
    {"jump", [](rig::Wishes& w) { w.position[0] = 0.06; }},
    {"short_jump", [](rig::Wishes& w) { w.position[0] = 0.006; }},
    {"orientation", [](rig::Wishes& w) { w.orientation[0] = 3; }},
    {"weight", [](rig::Wishes& w) { w.weight[1] = std::nan(""); }},
    {"switch_released", [](rig::Wishes& w) { w.buttons = 0; }},
    {"device_lost_at_10_kHz", [](rig::Wishes& w) { w.faults = rig::kLost; }, 0, 10000},
    {"jump_at_10_kHz", [](rig::Wishes& w) { w.position[0] = 0.039; }, 0, 10000},
    {"silent_at_10_kHz", [](rig::Wishes& w) { w.faults = rig::kSilent; }, 0, 10000},
    {"plugin_not_finite", nullptr, 1},
    {"plugin_status", nullptr, 2},
    {"plugin_lost", nullptr, 3},
    {"plugin_turns", nullptr, 4},
    {"plugin_pose", nullptr, 5},
};

/// At a low rate one command is held for a whole period, and what only a tick can find is found after it.
const Single kSlow[] = {
    {"lost_at_100_Hz", [](rig::Wishes& w) { w.faults = rig::kLost; }, 0, 100},
    {"silent_at_100_Hz", [](rig::Wishes& w) { w.faults = rig::kSilent; }, 0, 100},
    {"jump_at_100_Hz", [](rig::Wishes& w) { w.position[0] = 0.3; }, 0, 100},
    {"switch_released_at_100_Hz", [](rig::Wishes& w) { w.buttons = 0; }, 0, 100},
    {"not_a_number_at_20_Hz", [](rig::Wishes& w) { w.position[0] = std::nan(""); }, 0, 20},
    {"lost_at_190_Hz", [](rig::Wishes& w) { w.faults = rig::kLost; }, 0, 190},
    {"lost_at_250_Hz", [](rig::Wishes& w) { w.faults = rig::kLost; }, 0, 250},
    {"lost_at_350_Hz", [](rig::Wishes& w) { w.faults = rig::kLost; }, 0, 350},
    {"lost_at_360_Hz", [](rig::Wishes& w) { w.faults = rig::kLost; }, 0, 360},
    {"hardware_fault_at_250_Hz", [](rig::Wishes& w) { w.faults = rig::kHardwareFault; }, 0, 250},
    {"plugin_not_finite_at_100_Hz", nullptr, 1, 100},
    {"plugin_lost_at_100_Hz", nullptr, 3, 100},
    {"silent_arm_of_100_Hz", [](rig::Wishes& w) { w.faults = rig::kSilent; }, 0, 1000, 100},
    {"silent_arm_of_300_Hz", [](rig::Wishes& w) { w.faults = rig::kSilent; }, 0, 1000, 300},
    {"silent_arm_of_500_Hz", [](rig::Wishes& w) { w.faults = rig::kSilent; }, 0, 1000, 500},
    {"silent_arm_of_710_Hz", [](rig::Wishes& w) { w.faults = rig::kSilent; }, 0, 10000, 710},
};

class Energy : public testing::TestWithParam<Single> {};

TEST_P(Energy, OfAnySingleFaultIsSmall) {
  const Single& single = GetParam();
  const auto failing = hostile("failing", {value(0, HSP_ENUM, single.plugin), value(1, HSP_INT, kAt * single.rate)});
  Scenario scenario(
      {.rate = single.rate, .arm_rate = single.arm_rate, .models = {failing}, .limit = [](scene::Limits& limits) {
         limits.enable = {0, scene::EnableMode::kHold};
       }});
  const auto sent = scenario.run(0.4, [&](double t) {
    scenario.wishes().buttons = t > 0 ? 1 : 0;
    if (t >= kAt - 1e-6 && single.inject != nullptr) single.inject(scenario.wishes());
    return Nanoseconds{0};
  });
  FreePremium arm;
  double before = 0, held = 8;
  for (size_t i = 0; i + 1 < sent.size(); ++i) {
    if (sent[i].t < kAt - 1e-6) before = sent[i].force.norm();
    if (sent[i].t < kAt - single.since() - 1e-6) continue;
    arm.push(sent[i].force, sent[i + 1].t - sent[i].t);
  }
  if (!sent.empty() && sent.back().t >= kAt - 1e-6) held = sent.back().force.norm();
  std::printf("%-24s %6.3f mJ, %5.3f mm while pushed, %6.3f mm in 0.2 s\n", single.name, arm.energy() * 1e3,
              arm.way() * 1e3, arm.travel() * 1e3);
  EXPECT_NEAR(before, single.slow() ? before : 8, 0.1) << "a fast arm has all of its force";
  EXPECT_GT(before, 0.03) << "nothing was pushed: no test";
  EXPECT_EQ(held, 0);
  EXPECT_LE(arm.energy(), kMostEnergy);
  EXPECT_LE(arm.way(), kMostWay);
}
INSTANTIATE_TEST_SUITE_P(Slow, Energy, testing::ValuesIn(kSlow),
                         [](const auto& given) { return std::string(given.param.name); });
INSTANTIATE_TEST_SUITE_P(Each, Energy, testing::ValuesIn(kSingle),
                         [](const auto& given) { return std::string(given.param.name); });

}  // namespace
}  // namespace hapticd::servo
