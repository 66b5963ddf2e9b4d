// SPDX-License-Identifier: MIT
#include "transforms.hpp"

#include <gtest/gtest.h>

#include <array>

#include "mesh.hpp"

namespace hapticd::view {
namespace {

const Json kAbout = Json::parse(R"({
  "scene": {"models": [{"name": "door", "pose": {"position": [1, 2, 3], "orientation": [1, 0, 0, 0]}}]},
  "devices": [{"name": "arm"}],
  "columns": {"ticks": [{"name": "tick", "type": "u8", "offset": 0}, {"name": "arm0_x", "type": "f8", "offset": 8}],
              "poses": [{"name": "tick", "type": "u8", "offset": 0}, {"name": "model", "type": "u4", "offset": 8},
                        {"name": "x", "type": "f8", "offset": 16}]}})");

TEST(Frames, StandWhereTheSceneSaysUntilARowSaysOtherwise) {
  Frames frames(kAbout);
  ASSERT_EQ(frames.all().size(), 2u);
  EXPECT_EQ(frames.all()[0].name, "door");
  EXPECT_EQ(frames.all()[0].position[1], 2);
  struct {
    uint64_t tick = 5;
    uint32_t model = 0, reserved = 0;
    double frame[7] = {9, 8, 7, 0, 1, 0, 0};
  } pose;
  frames.take("poses", reinterpret_cast<const std::byte*>(&pose), 1, sizeof pose);
  EXPECT_EQ(frames.all()[0].position[0], 9);
  EXPECT_EQ(frames.all()[0].orientation[1], 1);
  pose.model = 77;  // one that came later and is not known here
  frames.take("poses", reinterpret_cast<const std::byte*>(&pose), 1, sizeof pose);
  struct {
    uint64_t tick = 5;
    double frame[7] = {0.1, 0.2, 0.3, 1, 0, 0, 0};
  } tick;
  frames.take("ticks", reinterpret_cast<const std::byte*>(&tick), 1, sizeof tick);
  EXPECT_EQ(frames.all()[1].name, "arm_tip");
  EXPECT_EQ(frames.all()[1].position[2], 0.3);
}

TEST(Frames, OfModelsThatCameLaterAreThereWhileTheModelIs) {
  Frames frames(kAbout);
  frames.list(Json::parse(R"({"models": [
    {"name": "door", "number": 0, "since": 0, "until": 10, "pose": {"position": [1, 2, 3]}},
    {"name": "door", "number": 0, "since": 20, "until": null, "pose": {"position": [4, 5, 6]}},
    {"name": "ball", "number": 1, "since": 15, "until": 30, "pose": {"position": [7, 8, 9]}}]})"));
  const auto at = [&](uint64_t now) {
    struct {
      uint64_t tick;
      double frame[7] = {0, 0, 0, 1, 0, 0, 0};
    } tick{now};
    frames.take("ticks", reinterpret_cast<const std::byte*>(&tick), 1, sizeof tick);
    std::string names;
    for (const Frame& frame : frames.all()) names += frame.name + " ";
    return names;
  };
  const auto moved = [&](uint64_t tick, uint32_t model, double x) {
    struct {
      uint64_t tick;
      uint32_t model, reserved = 0;
      double frame[7];
    } pose{tick, model, 0, {x, 0, 0, 1, 0, 0, 0}};
    frames.take("poses", reinterpret_cast<const std::byte*>(&pose), 1, sizeof pose);
  };
  EXPECT_EQ(at(9), "door arm_tip ");
  EXPECT_EQ(frames.all()[0].position[0], 1);
  EXPECT_EQ(at(10), "arm_tip ");
  moved(25, 0, 0.5);  // rows of poses may come before those of ticks
  moved(16, 1, 0.25);
  EXPECT_EQ(at(19), "ball arm_tip ");
  EXPECT_EQ(frames.all()[0].position[0], 0.25);
  EXPECT_EQ(at(20), "door ball arm_tip ");
  EXPECT_EQ(frames.all()[0].position[0], 0.5) << "of the second door";
  EXPECT_EQ(at(30), "door arm_tip ");
}

TEST(Frames, TakeNoRowsThatAreTooShort) {
  Frames frames(kAbout);
  uint64_t row = 3;
  frames.take("poses", reinterpret_cast<const std::byte*>(&row), 1, sizeof row);
  frames.take("ticks", reinterpret_cast<const std::byte*>(&row), 1, sizeof row);
  EXPECT_EQ(frames.all()[0].position[0], 1);
}

TEST(SceneRemoval, NamesTheEntity) {
  const Json update = Json::parse(sceneRemoval("a \"quoted\" name", 1'500'000'000));
  EXPECT_EQ(update["deletions"][0]["id"], "a \"quoted\" name");
  EXPECT_EQ(update["deletions"][0]["type"], 0) << "0 removes the entity with this id";
  EXPECT_TRUE(update["entities"].empty());
}

TEST(SceneUpdate, IsJsonWithEveryTriangle) {
  std::string mesh = headed(kMeshMessage, 3, 1, 1);
  const std::array<float, 18> places = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  const std::array<uint32_t, 3> corners = {0, 1, 2};
  mesh.append(reinterpret_cast<const char*>(places.data()), sizeof places);
  mesh.append(reinterpret_cast<const char*>(corners.data()), sizeof corners);
  const Json update = Json::parse(sceneUpdate("a \"quoted\" name", mesh, 1'500'000'000));
  EXPECT_EQ(update["entities"][0]["id"], "a \"quoted\" name");
  EXPECT_EQ(update["entities"][0]["timestamp"]["nsec"], 500'000'000);
  EXPECT_EQ(update["entities"][0]["triangles"][0]["indices"], Json::parse("[0,1,2]"));
  EXPECT_EQ(update["entities"][0]["triangles"][0]["points"][1]["x"], 1);
}

TEST(SceneUpdate, HasTheColoursOfTheModel) {
  std::string mesh = headed(kMeshMessage, 3, 1, kHasColours);
  const std::array<float, 9> places = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::array<uint32_t, 6> words = {0, 1, 2, 0xff0033ffu, 0, 0xff990000u};  // corners, then colours
  mesh.append(reinterpret_cast<const char*>(places.data()), sizeof places);
  mesh.append(reinterpret_cast<const char*>(words.data()), sizeof words);
  const Json triangles = Json::parse(sceneUpdate("part", mesh, 0))["entities"][0]["triangles"][0];
  EXPECT_EQ(triangles["indices"], Json::parse("[0,1,2]"));
  ASSERT_EQ(triangles["colors"].size(), 3u);
  EXPECT_EQ(triangles["colors"][0], Json::parse(R"({"r":1,"g":0.2,"b":0,"a":1})"));
  EXPECT_EQ(triangles["colors"][1], triangles["color"]) << "a vertex without a colour has the model's";
  EXPECT_EQ(triangles["colors"][2], Json::parse(R"({"r":0,"g":0,"b":0.6,"a":1})"));
}

}  // namespace
}  // namespace hapticd::view
