// SPDX-License-Identifier: MIT
/// Warnings of damping that makes one encoder count a knock.
#include "tune/noisy_damping.hpp"

#include <gtest/gtest.h>

namespace hapticd::tune {
namespace {

struct Noise {
  scene::Scene scene;
  scene::Device device;
  hdv_info info{};

  Noise(double rate, double resolution, double damping) {
    scene.file = "scene.yaml";
    scene.servo.rate = info.rate_hz = rate;
    info.resolution_m = resolution;
    device.name = "arm";
    scene::Value value;
    value.id = "damping", value.number = damping;
    scene.models.emplace_back().name = "wall";
    scene.models[0].parameters = {value};
  }
  void makeWall() {
    info.mass_kg = 0.075, info.max_force = 8.5;
    scene.models[0].plugin = "nurbs_rigid";
    scene::Value stiffness;
    stiffness.id = "stiffness", stiffness.number = 800;
    scene.models[0].parameters.push_back(stiffness);
  }
  std::string told() const {
    std::string all;
    for (const auto& problem : noisyDamping(scene, device, info)) all += problem.text() + "\n";
    return all;
  }
};

TEST(NoisyDamping, IsDampingTimesTheSpeedThatOneCountSeemsToHave) {
  // A window of three samples: 0.1178 mm in 0.3 ms are 0.39 m/s, and with 10 N s/m 3.9 N.
  const std::string told = Noise(10000, 117.8e-6, 10).told();
  EXPECT_NE(told.find("one count of arm (118 um) looks like 0.39 m/s at 10000 Hz"), std::string::npos) << told;
  EXPECT_NE(told.find("a knock of 3.9 N; expected a damping of at most 1.2 N s/m"), std::string::npos) << told;
  EXPECT_EQ(Noise(1000, 117.8e-6, 10).told(), "") << "0.39 N";
  EXPECT_EQ(Noise(10000, 30e-6, 2).told(), "");
  Noise swing(10000, 117.8e-6, 10);
  swing.scene.models[0].plugin = "pendulum";
  EXPECT_EQ(swing.told(), "") << "it damps the swing, not the hand";
}

TEST(NoisyDamping, IsGoneWithTheDampingThatItAdvises) {
  for (const double resolution : {29.4e-6, 33.6e-6, 117.8e-6})
    for (const double rate : {1000.0, 4000.0, 10000.0}) {
      const std::string told = Noise(rate, resolution, 200).told(), advice = "a damping of at most ";
      const size_t at = told.find(advice);
      ASSERT_NE(at, std::string::npos) << told;
      EXPECT_EQ(Noise(rate, resolution, std::stod(told.substr(at + advice.size()))).told(), "") << told;
    }
}

/// The damping of a wall grows with depth. At 4 N and 800 N/m a hand is 5 mm deep. It feels most of a knock of a light
/// arm.
TEST(NoisyDamping, OfAWallIsJudgedWhereAHandPresses) {
  Noise wall(1000, 29.4e-6, 26);
  EXPECT_EQ(wall.told(), "") << "a damper that does not grow";
  wall.makeWall();
  const std::string told = wall.told();
  EXPECT_NE(told.find("so 26 N s/m, which have grown to 130 where it pushes with 4 N, give a knock of 0.93 N; expected "
                      "a damping of at most 14 N s/m"),
            std::string::npos)
      << told;
  wall.scene.models[0].parameters[0].number = 14;
  EXPECT_EQ(wall.told(), "");
  wall.scene.models[0].parameters[0].number = 26, wall.info.mass_kg = 1.1;
  EXPECT_EQ(wall.told(), "") << "so heavy that a knock of some ticks hardly moves it";
  wall.scene.models[0].parameters[1].number = 8000;
  EXPECT_EQ(wall.told(), "") << "so stiff that it has not grown";
}

TEST(NoisyDamping, IsGoneWithTheWindowThatItAdvises) {
  Noise noisy(10000, 117.8e-6, 10);
  const std::string told = noisy.told(), advice = "servo.velocity.parameter: ";
  const size_t at = told.find(advice);
  ASSERT_NE(at, std::string::npos) << told;
  noisy.scene.servo.velocity.parameter = std::stod(told.substr(at + advice.size()));
  EXPECT_EQ(noisy.told(), "");
}

TEST(NoisyDamping, AdvisesNoWindowWithWhichTheDampingIsNotStable) {
  Noise wall(1000, 29.4e-6, 26);
  wall.makeWall();
  EXPECT_NE(wall.told().find("a damping of at most 14 N s/m"), std::string::npos) << wall.told();
  EXPECT_EQ(wall.told().find("longer window"), std::string::npos) << "six samples bear 173 N s/m at 8.5 N, not 276";
}

TEST(NoisyDamping, JudgesEachEstimatorByWhatItDoes) {
  Noise noisy(10000, 117.8e-6, 10);
  noisy.scene.servo.velocity = {"butterworth", 20};
  EXPECT_EQ(noisy.told(), "");
  noisy.scene.servo.velocity = {"butterworth", 1000};
  EXPECT_NE(noisy.told().find("damping of at most"), std::string::npos);
  EXPECT_EQ(noisy.told().find("longer window"), std::string::npos) << "it has none";
}

TEST(NoisyDamping, SaysNothingOfAnArmWhoseCountIsUnknown) {
  EXPECT_EQ(Noise(10000, 0, 100).told(), "");
}

}  // namespace
}  // namespace hapticd::tune
