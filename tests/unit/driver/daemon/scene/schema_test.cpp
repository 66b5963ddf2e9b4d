// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/format.hpp"
#include "scene/load.hpp"

namespace hapticd::scene {

using namespace document;
namespace {

/// Calls f(path, key) for every key of a format, nested ones too.
template <class F>
void eachKey(const Table& table, const std::string& path, F f) {
  for (const Key& key : table.keys) {
    f(path + key.name, key);
    if (key.table != nullptr) eachKey(*key.table, path + key.name + ".", f);
  }
}

TEST(Tables, DocumentEveryKeyInASentence) {
  for (const Format& format : kFormats)
    eachKey(*format.table, "", [](const std::string& path, const Key& key) {
      EXPECT_GT(std::string(key.doc).size(), 5u) << path;
      EXPECT_EQ(std::string(key.doc).back(), '.') << path;
      EXPECT_FALSE(key.expected().empty()) << path;
      EXPECT_NE(key.store, nullptr) << path;
    });
}

TEST(Tables, DefaultsAreAcceptedByTheirOwnParsers) {
  SceneText scene;
  DeviceText device;
  for (const Format& format : kFormats)
    eachKey(*format.table, "", [&](const std::string& path, const Key& key) {
      if (key.def == nullptr) return;
      Problems problems;
      const auto node = parseText(key.def, "default", problems);
      ASSERT_TRUE(node) << path;
      alignas(64) static char anything[4096];
      Servo servo;
      Limits limits;
      Pose pose;
      Velocity velocity;
      Admittance admittance;
      Daemon daemon;
      ModelText model;
      void* target = path.find("velocity.") != std::string::npos     ? static_cast<void*>(&velocity)
                     : path.find("limits.") != std::string::npos     ? static_cast<void*>(&limits)
                     : path.find("pose.") != std::string::npos       ? static_cast<void*>(&pose)
                     : path.find("mount.") != std::string::npos      ? static_cast<void*>(&pose)
                     : path.find("admittance.") != std::string::npos ? static_cast<void*>(&admittance)
                     : format.table == &kDaemonTable                 ? static_cast<void*>(&daemon)
                     : path.find("servo.") != std::string::npos      ? static_cast<void*>(&servo)
                     : path.find("models.") != std::string::npos     ? static_cast<void*>(&model)
                                                                     : static_cast<void*>(anything);
      ASSERT_NE(target, static_cast<void*>(anything)) << path;
      Reader in("default", problems);
      key.store(in, *node, path, key, target);
      EXPECT_TRUE(problems.empty()) << path << ": " << problems.front().text();
    });
}

TEST(Tables, DefaultsAreThoseOfTheStructs) {
  const std::string text =
      "hapticd: 1\nservo: {rate: 1000, activation_radius: 0.1, hysteresis: 0.05, gravity: [0, -9.81, 0], pace: clock, "
      "velocity: {estimator: window, parameter: 3}, budget_us: 0, instructions: auto}\nmodels: []\n";
  eachKey(*kFormats[0].table, "", [&](const std::string& path, const Key& key) {
    if (key.def == nullptr || path.find("servo.") != 0) return;
    EXPECT_NE(text.find(std::string(key.name) + ": " + key.def), std::string::npos) << path;
  });
  Problems problems;
  const auto root = parseText(text, "t", problems);
  SceneText given;
  Reader in("t", problems);
  in.object(*root, "", kSceneTable, &given);
  EXPECT_TRUE(problems.empty());
  const Servo def;
  EXPECT_EQ(given.servo.rate, def.rate);
  EXPECT_EQ(given.servo.activation_radius, def.activation_radius);
  EXPECT_EQ(given.servo.hysteresis, def.hysteresis);
  EXPECT_EQ(given.servo.gravity, def.gravity);
  EXPECT_EQ(given.servo.pace, def.pace);
  EXPECT_EQ(given.servo.velocity.estimator, def.velocity.estimator);
  EXPECT_EQ(given.servo.velocity.parameter, def.velocity.parameter);
  EXPECT_EQ(given.servo.budget_us, def.budget_us);
  const Limits limits;
  for (const auto& [name, value] :
       std::initializer_list<std::pair<const char*, double>>{{"torque", limits.torque},
                                                             {"slew", limits.slew},
                                                             {"torque_slew", limits.torque_slew},
                                                             {"power", limits.power},
                                                             {"impulse", limits.impulse},
                                                             {"workspace", limits.workspace},
                                                             {"ramp_in", limits.ramp_in},
                                                             {"ramp_out", limits.ramp_out}})
    EXPECT_EQ(toNumber(kDeviceTable.find("limits")->table->find(name)->def), value) << name;
  EXPECT_EQ(kDeviceTable.find("limits")->table->find("force")->def, nullptr);  // no number that may be written says it
}

TEST(Schema, IsValidJsonThatForbidsUnknownKeys) {
  host::Catalog catalog({{TEST_MODULES "/good"}, {TEST_MODULES "/good"}});
  for (const char* format : {"scene", "device", "daemon"}) {
    const auto json = nlohmann::json::parse(jsonSchema(format, &catalog));
    EXPECT_EQ(json["additionalProperties"], false) << format;
    EXPECT_EQ(json["type"], "object") << format;
  }
  const auto scene = nlohmann::json::parse(jsonSchema("scene", &catalog));
  EXPECT_EQ(scene["required"], nlohmann::json({"hapticd", "models"}));
  EXPECT_EQ(scene["properties"]["servo"]["properties"]["rate"]["default"], 1000);
  const auto& rules = scene["properties"]["models"]["items"]["allOf"];
  bool found = false;
  for (const auto& rule : rules) {
    if (rule["if"]["properties"]["plugin"]["const"] != "test_shape") continue;
    found = true;
    const auto& parameters = rule["then"]["properties"]["parameters"];
    EXPECT_EQ(parameters["required"], nlohmann::json({"radius"}));
    EXPECT_EQ(parameters["properties"]["inner"]["properties"]["mass"]["default"], 1);
  }
  EXPECT_TRUE(found);
  EXPECT_EQ(jsonSchema("opera", nullptr), "");
}

}  // namespace
}  // namespace hapticd::scene
