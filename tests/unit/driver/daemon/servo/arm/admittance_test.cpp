// SPDX-License-Identifier: MIT
/// Compliance control in the simulated Sarcos-like arm, from YAML to motor and back.
#include "servo/arm/admittance.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include "hapticd/device.h"
#include "scene/load.hpp"
#include "servo/arm/arm.hpp"
#include "servo/loop/lockstep.hpp"
#include "world/world.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 1.0 / 1500;
constexpr double kMass = 3, kDamping = 20;

std::string sceneText(const std::string& device, const std::string& hand, const std::string& models,
                      const std::string& mount = "") {
  return "hapticd: 1\nservo: {rate: 1500}\ndevices:\n  - file: " HAPTICD_SOURCE_DIR "/config/devices/" + device +
         "\n    mount: {" + mount + "}\n    admittance: {mass: 3, damping: 20}\n    hand: {" + hand +
         "}\nmodels: " + models + "\n";
}

scene::Loaded loadText(const std::string& text) {
  const auto folder = std::filesystem::temp_directory_path() / ("hapticd-admittance-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto file = folder / (::testing::UnitTest::GetInstance()->current_test_info()->name() + std::string(".yaml"));
  std::ofstream(file) << text;
  host::Catalog catalog;
  return scene::load(file, catalog);
}

const char* const kGuided =
    "script: guided, mass: 0.5, stiffness: 0, damping: 0, center: [0, 0, 0], radius: 0, tremor: 0, wander: 0";

/// The arm with a hand that only pushes: no spring, no damper.
struct Rig {
  explicit Rig(const std::string& hand = kGuided, const std::string& models = "[]", const std::string& mount = "") {
    scene::Loaded loaded = loadText(sceneText("simulated-sarcos.yaml", hand, models, mount));
    for (const document::Problem& problem : loaded.problems) ADD_FAILURE() << problem.text();
    const auto log = [](int, const std::string&, const std::string&) {};
    world = std::move(*World::build(*loaded.scene, {1500, 1, false, false}, log));
    auto opened = Arm::open(loaded.scene->devices[0], loaded.scene->servo, {1500, world->needsVelocity()}, log);
    if (!opened) throw std::runtime_error(opened.error());
    arm = std::move(*opened);
    handle = arm->device().handle();
    extension = static_cast<const hdv_ext_hand*>(arm->device().description().extension(handle, HDV_EXT_HAND));
    EXPECT_TRUE(arm->start(0, loaded.scene->servo.gravity));
    arm->carryWeight(true);
    lockstep.emplace(world->lockstep());
  }
  void tick(const Vector3d& target, const Vector3d& push) {
    const Vector3d still = Vector3d::Zero();
    extension->guide(handle, target.data(), still.data(), push.data());
    const double t = count * kPeriod, dt = count == 0 ? 0 : kPeriod;
    const auto now = static_cast<Nanoseconds>(std::llround(t * 1e9));
    ++count;
    const Probe& probe = arm->read(now, dt);
    Core& core = world->core();
    core.publish(t, {&probe, 1});
    lockstep->before(t);
    core.tick(t, dt, {&probe, 1});
    arm->write(now, dt, core.force(0), core.torque(0), core.exchange(0));
    Vector3d force;
    extension->truth(handle, tip.data(), velocity.data(), force.data());
  }
  std::unique_ptr<World> world;
  std::unique_ptr<Arm> arm;
  std::optional<Lockstep> lockstep;
  hdv_device* handle = nullptr;
  const hdv_ext_hand* extension = nullptr;
  Vector3d tip{0, 0, 0}, velocity{0, 0, 0};
  int count = 0;
};

TEST(Admittance, AConstantPushEndsInForceOverDamping) {
  for (const Vector3d& push : {Vector3d(2, 0, 0), Vector3d(0, 1.5, 0), Vector3d(0, 0, -2)}) {
    Rig rig;
    for (int i = 0; i < 2250; ++i) rig.tick({0, 0, 0}, push);  // six times the felt mass over b
    const Vector3d expected = push / kDamping;
    EXPECT_LT((rig.velocity - expected).norm(), 0.1 * expected.norm());
    EXPECT_EQ(rig.arm->limiter().fault(), Fault::kNone);
  }
}

TEST(Admittance, AnArmWithATurnedBaseYieldsInTheDirectionOfThePush) {
  const Eigen::Quaterniond turned(0.8, 0.2, -0.4, 0.4);
  for (const Vector3d& push : {Vector3d(2, 0, 0), Vector3d(0, 1.5, 0), Vector3d(0, 0, -2)}) {
    Rig rig(kGuided, "[]", "position: [0.1, -0.2, 0.3], orientation: [0.8, 0.2, -0.4, 0.4]");
    const auto pushFor = [&](int ticks) {
      for (int i = 0; i < ticks; ++i)
        rig.tick({0, 0, 0}, turned.conjugate() * push);  // the hand is in the device frame
      return rig.arm->probe().position;
    };
    constexpr int kLast = 150;
    const Vector3d before = pushFor(2250), velocity = (pushFor(kLast) - before) / (kLast * kPeriod);
    const Vector3d expected = push / kDamping;
    // a turn that is left out, or made twice, is off by 0.8 and more; the friction of the joints by 0.1
    EXPECT_LT((velocity - expected).norm(), 0.2 * expected.norm());
    EXPECT_LT((rig.arm->probe().velocity - expected).norm(), 0.2 * expected.norm());
    EXPECT_EQ(rig.arm->limiter().fault(), Fault::kNone);
  }
}

TEST(Admittance, AMovingHandFeelsTheVirtualMassAndDamperAndTheArmItHolds) {
  // The push that the load cells tell is m a + b v of the motion: fitted over three seconds of pushing to and fro.
  Rig rig;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  Vector3d last = Vector3d::Zero();
  double residual = 0, power = 0;
  std::vector<std::array<double, 3>> rows;
  for (int i = 0; i < 6000; ++i) {
    const double t = i * kPeriod;
    rig.tick({0, 0, 0}, {3 * std::sin(2 * M_PI * 0.7 * t) + 2 * std::sin(2 * M_PI * 1.9 * t), 0, 0});
    const Vector3d a = (rig.velocity - last) / kPeriod;
    last = rig.velocity;
    const auto felt = rig.arm->handForce();
    if (i < 1500 || !felt) continue;
    rows.push_back({a.x(), rig.velocity.x(), felt->x()});
  }
  for (const auto& [a, v, f] : rows) {
    const Eigen::Vector2d row(a, v);
    normal += row * row.transpose(), right += f * row;
  }
  const Eigen::Vector2d fit = normal.ldlt().solve(right);
  for (const auto& [a, v, f] : rows) residual += std::pow(f - kMass * a - kDamping * v, 2), power += f * f;
  EXPECT_NEAR(fit[0], kMass, 0.05 * kMass);
  EXPECT_NEAR(fit[1], kDamping, 0.05 * kDamping);
  EXPECT_LT(std::sqrt(residual / power), 0.1);
}

TEST(Admittance, StaysAtRestWithoutAHand) {
  Rig rig;
  for (int i = 0; i < 3000; ++i) rig.tick({0, 0, 0}, {0, 0, 0});
  EXPECT_LT(rig.velocity.norm(), 2e-3) << "noise of the torque sensors moves it a little";
  EXPECT_LT(rig.tip.norm(), 2e-3);
}

const std::string kWall =
    "[{name: box, plugin: nurbs_rigid, pose: {position: [0, 0, -0.06]}, parameters: {geometry: " HAPTICD_SOURCE_DIR
    "/config/models/box.yaml, stiffness: 2000}}]";

TEST(Admittance, AWallStopsTheVirtualMassAndTheArmWithIt) {
  // The front face is 10 mm before the tip; a hand of 300 N/m pulls to 30 mm behind the start.
  Rig rig("script: guided, mass: 0.5, stiffness: 300, damping: 10, center: [0, 0, 0], radius: 0, tremor: 0, wander: 0",
          kWall);
  double low = 1, high = -1;
  for (int i = 0; i < 6000; ++i) {
    rig.tick({0, 0, -0.03}, {0, 0, 0});
    if (i < 4500) continue;
    low = std::min(low, rig.tip.z()), high = std::max(high, rig.tip.z());
  }
  const double depth = -0.01 - rig.arm->admittance()->position().z();
  EXPECT_LT(high - low, 0.2e-3) << "at rest on the wall";
  EXPECT_NEAR(rig.tip.z(), rig.arm->admittance()->position().z(), 1e-3) << "the arm is where the virtual mass is";
  // Springs in series: 300 N/m over 20 mm less the depth against 2000 N/m.
  EXPECT_NEAR(depth, 300 * 0.02 / 2300, 0.5e-3);
  EXPECT_NEAR(rig.arm->force().z(), 2000 * depth, 0.05);
}

TEST(Admittance, StaysStableWhenTheHandTapsAStiffWall) {
  const std::string stiff = kWall.substr(0, kWall.find("2000")) + "6000" + kWall.substr(kWall.find("2000") + 4);
  Rig rig("script: guided, mass: 0.5, stiffness: 300, damping: 10, center: [0, 0, 0], radius: 0, tremor: 0, wander: 0",
          stiff);
  double first = 0, last = 0;
  for (int i = 0; i < 12000; ++i) {
    const double t = i * kPeriod;
    rig.tick({0, 0, -0.01 - 0.02 * std::sin(2 * M_PI * t)}, {0, 0, 0});
    const double depth = -0.01 - rig.tip.z();
    (i < 6000 ? first : last) = std::max(i < 6000 ? first : last, depth);
  }
  EXPECT_LT(last, 1.2 * first) << "taps do not grow";
  EXPECT_LT(last, 7e-3);
}

TEST(Admittance, StaysBoundedAtTheEndOfTheArmAndComesBack) {
  // Pulled out of reach by some 85 N: the reference stops with the arm stretched, and follows when the hand comes back.
  Rig rig("script: guided, mass: 0.5, stiffness: 300, damping: 20, center: [0, 0, 0], radius: 0, tremor: 0, wander: 0");
  double fastest = 0;
  for (int i = 0; i < 9000; ++i) {
    const double out = i < 4500 ? 0.5 : 0.0;
    rig.tick({0, 0, -out}, {0, 0, 0});
    fastest = std::max(fastest, rig.velocity.norm());
    ASSERT_TRUE(rig.tip.allFinite());
    if (i > 3000 && i < 4500) {
      EXPECT_LT(rig.velocity.norm(), 1.0);
      EXPECT_NEAR(rig.tip.z(), -0.21, 0.03);
    }
  }
  EXPECT_LT(fastest, 3);
  EXPECT_LT(rig.tip.norm(), 0.03) << "back where it began";
  EXPECT_EQ(rig.arm->limiter().fault(), Fault::kNone);
}

TEST(Admittance, TheVirtualMassWaitsForAnArmThatDoesNotFollow) {
  Rig rig;
  rig.tick({0, 0, 0}, {0, 0, 0});
  Admittance mass({kMass, kDamping}, rig.arm->device());
  ASSERT_TRUE(mass.start(rig.arm->sample().position));
  const Vector3d stuck = mass.position(), push(0, 0, -20);
  for (int i = 0; i < 1500; ++i) {
    mass.step(push, stuck, kPeriod);
    ASSERT_LE((mass.position() - stuck).norm(), Admittance::kMaxLead + 1e-4) << i;
  }
  EXPECT_LT(mass.velocity().norm(), 2 * kPeriod * push.norm() / kMass) << "it gathers no speed meanwhile";
}

TEST(Admittance, AFaultEndsItAndTheForceFades) {
  Rig rig("script: guided, mass: 0.5, stiffness: 300, damping: 10, center: [0, 0, 0], radius: 0, tremor: 0, wander: 0",
          kWall);
  for (int i = 0; i < 3000; ++i) rig.tick({0, 0, -0.03}, {0, 0, 0});
  EXPECT_EQ(rig.arm->command().mode, static_cast<uint32_t>(HDV_POSITION));
  rig.arm->limiter().trip(Fault::kStopped);
  rig.tick({0, 0, -0.03}, {0, 0, 0});
  EXPECT_EQ(rig.arm->command().mode, static_cast<uint32_t>(HDV_TORQUE)) << "only a force can be faded";
  for (int i = 0; i < 60; ++i) rig.tick({0, 0, -0.03}, {0, 0, 0});
  EXPECT_EQ(rig.arm->command().mode, static_cast<uint32_t>(HDV_OFF));
}

TEST(Admittance, RefusesAnArmWithoutTorqueSensorsInWords) {
  scene::Loaded loaded = loadText(sceneText("simulated-premium15.yaml", "script: none", "[]"));
  ASSERT_TRUE(loaded.scene);
  const auto opened =
      Arm::open(loaded.scene->devices[0], loaded.scene->servo, {1000, false}, [](int, const auto&, const auto&) {});
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().find("it measures no joint torques"), std::string::npos) << opened.error();
  EXPECT_NE(opened.error().find("Leave admittance out"), std::string::npos) << opened.error();
}

}  // namespace
}  // namespace hapticd::servo
