// SPDX-License-Identifier: MIT
#include "scene/load.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "hapticd/abi.h"

namespace hapticd::scene {

using document::Problem;
namespace {

namespace fs = std::filesystem;

class Load : public testing::Test {
 protected:
  void SetUp() override {
    dir_ = fs::temp_directory_path() / ("hapticd-load-" + std::to_string(::getpid()));
    fs::create_directories(dir_ / "models");
    put("arm.yaml",
        "hapticd-device: 1\nmodule: test_device\nname: arm\nmount: {position: [0, 0, 0.1]}\n"
        "limits: {force: 3, passivity: off}\nparameters: {gain: 2, port: /dev/nothing}\nhand: {mass: 0.2, mode: "
        "tap}\n");
    put("models/cup.yaml", "x\n");
    put("path.csv", "t,x,y,z\n0,0,0,0\n1,1,0,0\n");
  }
  void TearDown() override { fs::remove_all(dir_); }
  std::string put(const std::string& name, const std::string& text) {
    std::ofstream(dir_ / name) << text;
    return (dir_ / name).string();
  }
  Scene good(const std::string& text, const LoadOptions& options = {}) {
    Loaded loaded = load(put("scene.yaml", "hapticd: 1\n" + text), catalog_, options);
    for (const Problem& problem : loaded.problems) ADD_FAILURE() << problem.text();
    return loaded.scene ? *loaded.scene : Scene{};
  }
  const Value* value(const std::vector<Value>& values, const std::string& id) {
    for (const Value& v : values)
      if (v.id == id) return &v;
    return nullptr;
  }
  fs::path dir_;
  host::Catalog catalog_{host::SearchPath{{TEST_MODULES "/good"}, {TEST_MODULES "/good"}}};
};

TEST_F(Load, TellsHowProgramsOfTheHdapiSeeAnArm) {
  put("hd.yaml",
      "hapticd-device: 1\nmodule: test_device\nname: arm\nparameters: {gain: 2, port: /dev/nothing}\n"
      "hd: {model: PHANTOM Desktop, vendor: us, serial: '12', joints: [[2, -1, 0.5], [0], [1, 1]], buttons: [1, 0]}\n");
  const Scene scene =
      good("device: hd.yaml\nclients: {mode: add, push: false, origin: [0.1, 0, -0.2], frame: device}\nmodels: []\n");
  ASSERT_EQ(scene.devices.size(), 1u);
  ASSERT_TRUE(scene.devices[0].hd);
  const HdArm& hd = *scene.devices[0].hd;
  EXPECT_EQ(hd.model, "PHANTOM Desktop");
  EXPECT_EQ(hd.vendor, "us");
  EXPECT_EQ(hd.serial, "12");
  ASSERT_EQ(hd.joints.size(), 3u);
  EXPECT_EQ(hd.joints[0].joint, 2u);
  EXPECT_EQ(hd.joints[0].sign, -1);
  EXPECT_EQ(hd.joints[0].offset, 0.5);
  EXPECT_EQ(hd.joints[1].sign, 1);
  EXPECT_EQ(hd.buttons, (std::vector<uint32_t>{1, 0}));
  EXPECT_FALSE(scene.clients.push);
  EXPECT_EQ(scene.clients.origin, Eigen::Vector3d(0.1, 0, -0.2));
  EXPECT_EQ(scene.clients.frame, ClientFrame::kDevice);
}

TEST_F(Load, RefusesWrongHdKeysByName) {
  const auto refused = [&](const std::string& device, const std::string& clients, const std::string& expected) {
    put("hd.yaml", "hapticd-device: 1\nmodule: test_device\nparameters: {gain: 2, port: /dev/nothing}\n" + device);
    const Loaded loaded = load(put("scene.yaml", "hapticd: 1\ndevice: hd.yaml\n" + clients + "models: []\n"), catalog_);
    ASSERT_FALSE(loaded.problems.empty()) << expected;
    EXPECT_NE(loaded.problems[0].text().find(expected), std::string::npos) << loaded.problems[0].text();
  };
  refused("hd: {modell: x}\n", "", "(did you mean \"model\"?)");
  refused("hd: {joints: 3}\n", "", "hd.joints: 3, expected a list of up to 6");
  refused("hd: {joints: [[0, 0]]}\n", "", "hd.joints[0][1]: 0, expected 1 or -1");
  refused("hd: {joints: [[16]]}\n", "", "hd.joints[0][0]");
  refused("hd: {joints: [2]}\n", "", "expected [joint, sign, offset]");
  refused("hd: {joints: [[0],[1],[2],[3],[4],[5],[6]]}\n", "", "a list of 7, expected a list of up to 6");
  refused("hd: {buttons: [99]}\n", "", "hd.buttons[0]");
  refused("", "clients: {mode: add, frame: arm}\n", "clients.frame");
  refused("", "clients: {mode: add, orgin: [0, 0, 0]}\n", "(did you mean \"origin\"?)");
  refused("", "clients: {mode: add, origin: [0, 0]}\n", "clients.origin");
}

TEST_F(Load, ReportsTheProblemsOfADeviceBesideAListOfDevices) {
  const auto told = [&](const std::string& top) {
    std::string all;
    for (const auto& problem : load(put("scene.yaml", "hapticd: 1\n" + top + "models: []\n"), catalog_).problems)
      all += problem.text() + "\n";
    return all;
  };
  const std::string wrong = "hapticd-device: 1\nmodule: test_device\nparameters: {gain: 2, port: /dev/nothing}\n";
  put("one.yaml", wrong + "hd: {modell: x}\n"), put("two.yaml", wrong + "hd: {serail: 1}\n");
  const std::string both = told("device: one.yaml\ndevices: [two.yaml]\n");
  for (const char* one : {"both device and devices", "did you mean \"model\"", "did you mean \"serial\""})
    EXPECT_NE(both.find(one), std::string::npos) << one << "\n" << both;
  const std::string absent = told("device: absent.yaml\ndevices: [two.yaml]\n");
  EXPECT_NE(absent.find("there is no file"), std::string::npos) << absent;
  std::filesystem::create_symlink("itself.yaml", dir_ / "itself.yaml");
  const std::string itself = told("device: itself.yaml\ndevices: [two.yaml]\n");
  EXPECT_EQ(itself.find("did you mean \"itself"), std::string::npos) << itself;
  const std::string same = told("device: two.yaml\ndevices: [two.yaml]\n");
  EXPECT_EQ(same.find("serail"), same.rfind("serail")) << same;
}

TEST_F(Load, SaysThatARateSeemsToBeInKilohertz) {
  const Loaded loaded =
      load(put("scene.yaml", "hapticd: 1\ndevice: arm.yaml\nservo: {rate: 1}\nmodels: []\n"), catalog_);
  ASSERT_FALSE(loaded.problems.empty());
  EXPECT_NE(loaded.problems[0].text().find("; 1 kHz is 1000 Hz"), std::string::npos) << loaded.problems[0].text();
}

TEST_F(Load, FillsEveryKindOfParameter) {
  const Scene scene = good(
      "device: arm.yaml\nmodels:\n  - name: cup\n    plugin: test_shape\n"
      "    pose: {position: [1, 2, 3], orientation: [0.9995, 0, 0, 0]}\n"
      "    parameters:\n      radius: 0.5\n      count: 3\n      flag: on\n      sides: both\n      geometry: "
      "models/cup.yaml\n"
      "      label: 12\n      axis: [0, 0, 1]\n      detent: [[0, 1], [2, 3]]\n      extra: {a: [1, x]}\n      inner: "
      "{mass: 2}\n");
  ASSERT_EQ(scene.models.size(), 1u);
  const Model& cup = scene.models[0];
  EXPECT_EQ(cup.name, "cup");
  EXPECT_EQ(cup.library.filename(), "test_shape.so");
  EXPECT_EQ(cup.pose.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(cup.pose.orientation.w(), 1);
  EXPECT_EQ(cup.place.line, 4);
  EXPECT_EQ(value(cup.parameters, "radius")->number, 0.5);
  EXPECT_EQ(value(cup.parameters, "count")->number, 3);
  EXPECT_EQ(value(cup.parameters, "flag")->number, 1);
  EXPECT_EQ(value(cup.parameters, "sides")->number, 2);
  EXPECT_EQ(value(cup.parameters, "geometry")->text, (dir_ / "models/cup.yaml").string());
  EXPECT_EQ(value(cup.parameters, "label")->text, "12");
  EXPECT_EQ(value(cup.parameters, "axis")->numbers, (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(value(cup.parameters, "detent")->numbers, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(value(cup.parameters, "extra")->text, R"({"a":[1,"x"]})");
  EXPECT_EQ(value(cup.parameters, "inner.mass")->number, 2);
  EXPECT_EQ(value(cup.parameters, "inner.mass")->place.line, 17);
  EXPECT_EQ(value(cup.parameters, "stiffness"), nullptr);
}

TEST_F(Load, ReadsTheServoAndKeepsItsDefaults) {
  const Scene scene = good(
      "device: arm.yaml\nservo: {rate: 4000, pace: device, velocity: {estimator: kalman}, spin_us: 20}\nmodels: []\n");
  EXPECT_EQ(scene.servo.rate, 4000);
  EXPECT_EQ(scene.servo.pace, Pace::kDevice);
  EXPECT_EQ(scene.servo.velocity.estimator, "kalman");
  EXPECT_EQ(scene.servo.spin_us, 20);
  EXPECT_EQ(scene.servo.gravity, Eigen::Vector3d(0, -9.81, 0));
  EXPECT_EQ(scene.servo.hysteresis, 0.05);
}

TEST_F(Load, ReadsTheDeviceFileAndItsHand) {
  const Scene scene = good("device: arm.yaml\nmodels: []\n");
  ASSERT_EQ(scene.devices.size(), 1u);
  const Device& arm = scene.devices[0];
  EXPECT_EQ(arm.name, "arm");
  EXPECT_EQ(arm.mount.position.z(), 0.1);
  EXPECT_EQ(arm.limits.force, 3);
  EXPECT_EQ(arm.limits.passivity, false);
  EXPECT_FALSE(arm.chosen_by_default);
  EXPECT_EQ(value(arm.parameters, "gain")->number, 2);
  EXPECT_EQ(value(arm.parameters, "port")->text, "/dev/nothing");
  EXPECT_EQ(value(arm.parameters, "hand.mass")->number, 0.2);
  EXPECT_EQ(value(arm.parameters, "hand.mode")->text, "tap");
}

TEST_F(Load, TheScenesHandReplacesTheDevicesKeyByKey) {
  const Scene scene = good("device: arm.yaml\nhand: {mass: 0.7}\nmodels: []\n");
  const auto& parameters = scene.devices.at(0).parameters;
  EXPECT_EQ(value(parameters, "hand.mass")->number, 0.7);
  EXPECT_EQ(value(parameters, "hand.mode")->text, "tap");
  EXPECT_EQ(parameters.size(), 4u);
}

TEST_F(Load, TwoArmsOfOneFileNeedNamesAndMayDifferInMountAndHand) {
  const Scene scene = good(
      "devices:\n  - {file: arm.yaml, name: left, mount: {position: [-0.2, 0, 0]}}\n"
      "  - {file: arm.yaml, name: right, hand: {mass: 1}}\nhand: {mass: 2}\nmodels: []\n");
  ASSERT_EQ(scene.devices.size(), 2u);
  EXPECT_EQ(scene.devices[0].name, "left");
  EXPECT_EQ(scene.devices[0].mount.position.x(), -0.2);
  EXPECT_EQ(value(scene.devices[0].parameters, "hand.mass")->number, 2);
  EXPECT_EQ(scene.devices[1].mount.position.z(), 0.1);
  EXPECT_EQ(value(scene.devices[1].parameters, "hand.mass")->number, 1);
}

TEST_F(Load, AnotherDeviceFileReplacesTheScenes) {
  put("other.yaml", "hapticd-device: 1\nmodule: test_device\n");
  const Scene scene = good("device: arm.yaml\nmodels: []\n", {true, dir_ / "other.yaml"});
  ASSERT_EQ(scene.devices.size(), 1u);
  EXPECT_EQ(scene.devices[0].name, "other");
}

TEST_F(Load, WithoutADeviceNoneIsTakenWhereNoneIsNeeded) {
  EXPECT_TRUE(good("models: []\n", {false, {}}).devices.empty());
}

TEST_F(Load, MotionAndPathMayStandBesideThePluginOrAmongItsParameters) {
  const std::string head = "device: arm.yaml\nmodels:\n  - name: a\n    plugin: test_shape\n";
  const Scene beside = good(head + "    motion: kinematic\n    path: path.csv\n    parameters: {radius: 0.1}\n");
  const Scene led = good(head + "    motion: kinematic\n    parameters: {radius: 0.1}\n");
  EXPECT_TRUE(led.models.at(0).kinematic);
  EXPECT_TRUE(led.models.at(0).path.empty()) << "it rests until a program leads it";
  const Scene among = good(head + "    parameters: {radius: 0.1, motion: kinematic, path: path.csv}\n");
  for (const Scene& scene : {beside, among}) {
    const Model& model = scene.models.at(0);
    EXPECT_TRUE(model.kinematic);
    ASSERT_EQ(model.path.size(), 2u);
    EXPECT_EQ(model.path[1].pose.position.x(), 1);
    EXPECT_EQ(value(model.parameters, "motion")->number, 1);
  }
  const Scene other =
      good("device: arm.yaml\nmodels:\n  - {name: a, plugin: small_minor, motion: kinematic, path: path.csv}\n");
  EXPECT_TRUE(other.models.at(0).kinematic);
  EXPECT_TRUE(other.models.at(0).parameters.empty());
}

TEST_F(Load, PathsAreSeenFromTheFileThatNamesThem) {
  fs::create_directories(dir_ / "scenes");
  std::ofstream(dir_ / "scenes/s.yaml") << "hapticd: 1\ndevice: ../arm.yaml\nmodels: []\n";
  const Loaded loaded = load(dir_ / "scenes/s.yaml", catalog_);
  ASSERT_TRUE(loaded.scene) << loaded.problems.front().text();
  EXPECT_EQ(loaded.scene->devices[0].name, "arm");
}

TEST_F(Load, GivesNoSceneWithAnyProblemAndAllProblemsInOrder) {
  const Loaded loaded =
      load(put("bad.yaml", "hapticd: 1\nservo: {rate: -1}\nmodels: 3\ndevice: gone.yaml\n"), catalog_);
  EXPECT_FALSE(loaded.scene);
  ASSERT_EQ(loaded.problems.size(), 3u);
  EXPECT_EQ(loaded.problems[0].place.line, 2);
  EXPECT_EQ(loaded.problems[1].place.line, 3);
  EXPECT_EQ(loaded.problems[2].place.line, 4);
}

TEST_F(Load, RefusesAPipeAtOnceWhereverAFileIsNamed) {
  const std::string pipe = dir_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto toldOf = [](const Loaded& loaded) {
    std::string all;
    for (const Problem& problem : loaded.problems) all += problem.text() + "\n";
    return all;
  };
  EXPECT_NE(toldOf(load(pipe, catalog_, {})).find("is a pipe, expected a file"), std::string::npos);
  for (const char* rest :
       {"models: [{name: cup, plugin: test_shape, parameters: {geometry: pipe}}]\n",
        "models: [{name: cup, plugin: test_shape, motion: kinematic, path: pipe}]\n", "device: pipe\nmodels: []\n"}) {
    const std::string told = toldOf(load(put("scene.yaml", std::string("hapticd: 1\n") + rest), catalog_, {}));
    EXPECT_NE(told.find("pipe is a pipe, expected a file"), std::string::npos) << told;
  }
}

TEST_F(Load, DescribesOnlyThePluginsThatTheSceneNames) {
  good("device: arm.yaml\nmodels:\n  - {name: a, plugin: test_shape, parameters: {radius: 0.1}}\n");
  EXPECT_EQ(catalog_.described(), 2u);
}

TEST_F(Load, ReadsADaemonFile) {
  const LoadedDaemon loaded = loadDaemon(put(
      "daemon.yaml", "hapticd-daemon: 1\nplugin_path: [models]\nservo: {cpu: 3, priority: 70}\nlimits: {force: 5}\n"));
  ASSERT_TRUE(loaded.daemon) << loaded.problems.front().text();
  EXPECT_EQ(loaded.daemon->plugin_path, std::vector<fs::path>{dir_ / "models"});
  EXPECT_EQ(loaded.daemon->cpu, 3);
  EXPECT_EQ(loaded.daemon->priority, 70);
  EXPECT_EQ(loaded.daemon->force, 5);
  EXPECT_FALSE(loaded.daemon->rate);
}

}  // namespace
}  // namespace hapticd::scene
