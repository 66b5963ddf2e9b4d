// SPDX-License-Identifier: MIT
#include "record/scene_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hapticd::record {
namespace {

scene::Scene sceneWithEveryLimit() {
  scene::Scene scene;
  scene.servo.spin_us = 20;
  scene.models.emplace_back().name = "wall";
  scene.models[0].enabled = false;
  scene::Device& device = scene.devices.emplace_back();
  device.name = "arm";
  device.admittance = {2, 30};
  device.hd = {"Desktop", "us", "12", {{1, -1, 0.5}}, {2, 0}};
  scene.clients = {scene::ClientMode::kAdd, 2, true, 50e-6, false, {1, 2, 3}, scene::ClientFrame::kDevice};
  scene::Limits& limits = device.limits;
  limits.torque_slew = 5, limits.power = 2, limits.impulse = 0.3, limits.passivity = true;
  limits.enable = {1, scene::EnableMode::kToggle};
  limits.motors.emplace_back();
  return scene;
}

TEST(SceneJson, ComesBackAsItWas) {
  const std::string once = sceneToJson(sceneWithEveryLimit());
  const auto scene = sceneFromJson(once);
  ASSERT_TRUE(scene) << scene.error();
  EXPECT_EQ(sceneToJson(*scene), once);
  EXPECT_EQ(scene->devices[0].limits.enable.button, 1);
  EXPECT_EQ(scene->devices[0].limits.power, 2);
  ASSERT_TRUE(scene->devices[0].hd);
  EXPECT_EQ(scene->devices[0].hd->joints.at(0).sign, -1);
  EXPECT_EQ(scene->devices[0].hd->buttons.at(0), 2u);
  EXPECT_FALSE(scene->models[0].enabled);
  EXPECT_FALSE(scene->clients.push);
  EXPECT_EQ(scene->clients.origin.y(), 2);
  EXPECT_EQ(scene->clients.frame, scene::ClientFrame::kDevice);
}

TEST(SceneJson, AnOlderRecordingWasMadeWithoutWhatCameLater) {
  auto json = nlohmann::json::parse(sceneToJson(sceneWithEveryLimit()));
  auto& device = json["devices"][0];
  for (const char* key : {"torque_slew", "power", "impulse", "enable", "motors"}) device["limits"].erase(key);
  device.erase("admittance");
  device.erase("hd");
  for (const char* key : {"answer_time", "push", "origin", "frame"}) json["clients"].erase(key);
  json["servo"].erase("spin_us");
  json["models"][0].erase("enabled");
  const auto scene = sceneFromJson(json.dump());
  ASSERT_TRUE(scene) << scene.error();
  const scene::Limits& limits = scene->devices[0].limits;
  EXPECT_EQ(limits.torque_slew, 0);
  EXPECT_EQ(limits.power, 0);
  EXPECT_EQ(limits.impulse, 0);
  EXPECT_FALSE(limits.enable.button);
  EXPECT_TRUE(limits.motors.empty());
  EXPECT_FALSE(scene->devices[0].admittance);
  EXPECT_FALSE(scene->servo.spin_us);
  EXPECT_FALSE(scene->devices[0].hd);
  EXPECT_TRUE(scene->clients.push);
  EXPECT_TRUE(scene->models[0].enabled);
  EXPECT_EQ(scene->clients.frame, scene::ClientFrame::kWorld);
}

TEST(SceneJson, SaysWhatIsMissing) {
  for (const char* key : {"force", "slew", "velocity", "workspace", "ramp_in", "ramp_out"}) {
    auto json = nlohmann::json::parse(sceneToJson(sceneWithEveryLimit()));
    json["devices"][0]["limits"].erase(key);
    const auto scene = sceneFromJson(json.dump());
    ASSERT_FALSE(scene) << key;
    EXPECT_NE(scene.error().find(key), std::string::npos) << scene.error();
  }
}

}  // namespace
}  // namespace hapticd::record
