// SPDX-License-Identifier: MIT
/// Warnings of settings that cannot be stable, and the bound behind them.
#include "tune/stability.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "servo/safety/passivity/isolated.hpp"

namespace hapticd::tune {
namespace {

/// From a root finder over the characteristic polynomial: largest K T^2 / m for a window of n samples.
TEST(MassAlone, BearsTheStiffnessOfTheRootsOfItsPolynomial) {
  const std::pair<int, double> truth[] = {{1, 0.684},   {2, 0.343},    {3, 0.213},    {5, 0.109},
                                          {15, 0.0207}, {50, 0.00263}, {100, 0.00074}};
  for (const auto& [n, k] : truth) EXPECT_NEAR(passivity::maxStiffnessAlone(1, n, 1) / k, 1, 0.01) << n;
  EXPECT_NEAR(passivity::maxStiffnessAlone(0.075, 1, 1e-3), 0.684 * 0.075 * 1e6, 600);
}

/// From the same: largest B T / m.
TEST(MassAlone, BearsTheDampingOfTheRootsOfItsPolynomial) {
  const std::pair<int, double> truth[] = {{1, 2}, {2, 4.0 / 3}, {3, 1.0294}};
  for (const auto& [n, b] : truth) EXPECT_NEAR(passivity::maxDampingAlone(1, n, 1) / b, 1, 0.01) << n;
  EXPECT_NEAR(passivity::maxDampingAlone(0.075, 1, 1e-3), 150, 1.5);
}

struct Case {
  scene::Scene scene;
  scene::Device device;
  hdv_info info{};
  Case() {
    scene.file = "scene.yaml";
    scene.models.emplace_back().name = "wall";
    device.name = "arm";
    info.mass_kg = 0.075;
    info.max_stiffness = 3500;
    info.resolution_m = 30e-6;
    info.rate_hz = 1000;
  }
  std::string told(double stiffness) const {
    std::string all;
    for (const auto& problem : unstableSettings(scene, device, info, {stiffness})) all += problem.text() + "\n";
    return all;
  }
};

scene::PathPoint pointOf(double t, double x, double angle) {
  return {t, {Eigen::Vector3d(x, 0, 0), Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()))}};
}

TEST(FastPaths, AreToldOnceWithTheirPlaceAndTheirFastestPiece) {
  scene::Scene scene;
  scene.models.resize(2);
  scene.models[0].name = "door";
  scene.models[0].path = {pointOf(0, 0, 0), pointOf(1, 1, 3), pointOf(2, 0, 0)};  // at the bounds
  EXPECT_TRUE(fastPaths(scene).empty());
  scene.models[1].name = "ball";
  const std::string file = testing::TempDir() + "fast_paths.yaml";
  std::ofstream(file) << "models:\n  - name: door\n    path: slow.csv\n  - name: ball\n    path: fast.csv\n";
  scene.models[1].place = {file, 4, 5};
  scene.models[1].path = {pointOf(0, 0, 0), pointOf(1, 0.1, 0), pointOf(1.1, 0.6, 0), pointOf(1.3, 0.6, 2)};
  std::ofstream(testing::TempDir() + "fast.csv")
      << "# made by hand\nt,x,y,z\n0,0,0,0\n1,0.1,0,0\n1.1,0.6,0,0\n1.3,0.6,0,0\n";
  const document::Problems found = fastPaths(scene);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].text().find(file + ":5:11: models[1].path: ball moves at up to 5 m/s, from t = 1 s (fast.csv:4), "
                                        "and a path"),
            0u)
      << found[0].text();
  EXPECT_EQ(found[0].text().find("must be in m"), std::string::npos) << found[0].text();
  EXPECT_NE(found[1].text().find("turns at up to 10 rad/s, from t = 1.1 s"), std::string::npos) << found[1].text();
}

TEST(FastPaths, AreToldOfPositionsThatSeemToBeInMillimetres) {
  scene::Scene scene;
  scene.models.resize(1);
  scene.models[0].path = {pointOf(0, 0, 0), pointOf(1, 50, 0)};
  const document::Problems found = fastPaths(scene);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].text().find("positions must be in m: 50 mm is 0.05 m"), std::string::npos) << found[0].text();
}

TEST(UnstableSettings, AreNoneWhereTheArmBearsThem) {
  EXPECT_EQ(Case().told(800), "");
}

TEST(UnstableSettings, NameTheBoundAndTheNearestSetting) {
  const std::string text = Case().told(5000);
  EXPECT_NE(text.find("stable up to 3500 N/m"), std::string::npos) << text;
  EXPECT_NE(text.find("expected at most 3300 N/m"), std::string::npos) << text;  // of the buzz
  EXPECT_NE(text.find("models[0]"), std::string::npos) << text;
}

TEST(UnstableSettings, SayThatAnArmCannotDriveTheLoopOrDoesSoAtAnotherRate) {
  Case paced;
  paced.scene.servo.pace = scene::Pace::kDevice;
  paced.info.capabilities &= ~uint32_t{HDV_C_PACING};
  EXPECT_NE(paced.told(800).find("servo.pace: the samples of arm cannot drive the loop"), std::string::npos)
      << paced.told(800);
  paced.info.capabilities |= HDV_C_PACING;
  paced.info.rate_hz = paced.scene.servo.rate;
  EXPECT_EQ(paced.told(800), "");
  paced.info.rate_hz = paced.scene.servo.rate / 2;
  EXPECT_NE(paced.told(800).find("servo.rate"), std::string::npos) << paced.told(800);
}

TEST(UnstableSettings, SayThatAWindowIsTooLong) {
  Case slow;
  slow.scene.servo.velocity = {"window", 15};
  const std::string text = slow.told(2000);
  EXPECT_NE(text.find("without damping of the arm"), std::string::npos) << text;
  EXPECT_NE(text.find("Hz, or servo.velocity.parameter: 12 (a window of 15 samples"), std::string::npos) << text;
  slow.scene.servo.velocity.parameter = 13;
  EXPECT_NE(slow.told(2000), "") << "one sample more than it names is too long";
  slow.scene.servo.velocity.parameter = 12;
  EXPECT_EQ(slow.told(2000), "");
}

/// 50 N s/m at 0.8 N are 530 N s/m at 8.5 N: such a wall threw a simulated hand about until it was silenced.
TEST(UnstableSettings, SayThatADampingThatGrowsWithDepthIsTooLarge) {
  Case damped;
  damped.scene.models[0].plugin = "nurbs_rigid";
  damped.info.max_force = 8.5;
  const auto give = [&](const char* id, double number) {
    scene::Value value;
    value.id = id;
    value.number = number;
    damped.scene.models[0].parameters.push_back(value);
  };
  give("stiffness", 800);
  give("damping", 50);
  const std::string text = damped.told(800);
  EXPECT_NE(text.find("wall damps with 531.2 N s/m where it pushes with the 8.5 N of arm"), std::string::npos) << text;
  EXPECT_NE(text.find("expected at most 26 N s/m"), std::string::npos) << text;
  damped.scene.models[0].parameters[1].number = 26;
  EXPECT_EQ(damped.told(800).find("damps"), std::string::npos);
  damped.scene.models[0].parameters[1].number = 50;
  give("depth_scale", 0.01);
  EXPECT_EQ(damped.told(800).find("damps"), std::string::npos);
}

TEST(UnstableSettings, SayThatABudgetIsBeyondThePeriodAndARateBeyondTheDevice) {
  Case late;
  late.scene.servo.budget_us = 1500;
  late.scene.servo.rate = 2000;
  const std::string text = late.told(100);
  EXPECT_NE(text.find("servo.budget_us"), std::string::npos) << text;
  EXPECT_NE(text.find("servo.rate"), std::string::npos) << text;
}

TEST(UnstableSettings, SayThatNothingSparesTheMotorsOfAnArmThatIsHeld) {
  Case held;
  held.info.max_force = 8.5;
  held.info.continuous_force = 1.4;
  EXPECT_NE(held.told(100).find("sustains 1.4 N"), std::string::npos) << held.told(100);
  Case limited = held, modelled = held, simulated = held;
  limited.device.limits.force = 1.4;
  modelled.device.limits.motors.resize(3);
  simulated.info.capabilities = HDV_C_SIMULATED;
  for (const Case* quiet : {&limited, &modelled, &simulated}) EXPECT_EQ(quiet->told(100), "");
}

TEST(Overheating, IsToldOfTheRootOfTheMeanSquareBeyondWhatIsSustained) {
  const std::vector<double> pulses = {0, 4, 0, 0};  // heats as 2 N do
  EXPECT_NE(overheating("arm", 1.4, pulses, 1).find("2 N"), std::string::npos);
  EXPECT_NE(overheating("arm", 1.4, pulses, 1).find("the last 4 s"), std::string::npos);
  EXPECT_EQ(overheating("arm", 2.1, pulses, 1), "");
  EXPECT_EQ(overheating("arm", 0, pulses, 1), "");  // unknown
}

TEST(Overheating, NamesTheProgramThatPushedWhereNoModelWasTouched) {
  const std::string text = overheating("arm", 1.4, {2, 2}, 1, "process 12 (spring.py)");
  EXPECT_NE(text.find("process 12 (spring.py) pushed"), std::string::npos) << text;
  EXPECT_NE(text.find("clients.max_force: 1.4"), std::string::npos) << text;
  EXPECT_EQ(text.find("softer model"), std::string::npos) << text;
}

}  // namespace
}  // namespace hapticd::tune
