// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <vector>

#include "commands_fixture.hpp"

namespace hapticd::test {
namespace {

using DeviceCommands = Commands;

TEST_F(DeviceCommands, DeviceListAndInfoTellTheFacts) {
  EXPECT_TRUE(has(run("device list").text, "test_device        0.1.0"));
  const Outcome outcome = run("device info " + put("arm.yaml", kArm));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "joints  2")) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "hardware: test arm")) << outcome.text;
  const Outcome absent =
      run("device info " + put("absent.yaml", "hapticd-device: 1\nmodule: test_device\nparameters: {gain: 0}\n"));
  EXPECT_EQ(absent.exit_code, 0) << absent.text;
  EXPECT_TRUE(has(absent.text, "no arm on the bus")) << absent.text;
}

TEST_F(DeviceCommands, KinematicsGivesPoseJacobianAndTorques) {
  const std::string arm = put("arm.yaml", kArm), joints = put("joints.csv", "q1,q2,fx,fy,fz\n0.25,-0.5,3,4,5\n");
  const Outcome outcome =
      run("device kinematics " + arm + " --joints " + joints + " -o " + (dir_ / "out.csv").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_EQ(get("out.csv"),
            "q1,q2,x,y,z,qw,qx,qy,qz,J1_1,J1_2,J2_1,J2_2,J3_1,J3_2,J4_1,J4_2,J5_1,J5_2,J6_1,J6_2,gravity1,gravity2,"
            "tau1,tau2\n"
            "0.25,-0.5,0.25,-0.5,0,1,0,0,0,1,0,0,1,0,0,0,0,0,0,0,0,-0,9.8100000000000005,3,4\n");
  const Outcome wrong = run("device kinematics " + arm + " --joints " + put("wrong.csv", "q1,q2\n0,nan\n"));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(has(wrong.text, "wrong.csv:2:3: q2: \"nan\" is not valid")) << wrong.text;
}

TEST_F(DeviceCommands, CheckPlacesWhatADeviceModuleRefusesInTheFile) {
  std::ifstream shipped(HAPTICD_SOURCE_DIR "/config/devices/sarcos.yaml");
  std::string good((std::istreambuf_iterator<char>(shipped)), {});
  const std::string window = "/dev/bus/vme/m0";
  good.replace(good.find(window), window.size(), put("window", ""));
  const auto problem = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const std::string file = put("sarcos.yaml", text);
    const Outcome outcome = run("check " + file, kShipped);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.text;
    // Where the value stands: its line, and its column after "key: ".
    const size_t value = at + to.find(": ") + 2, line_start = text.rfind('\n', value) + 1;
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(value), '\n');
    const std::string place = file + ":" + std::to_string(line) + ":" + std::to_string(value - line_start + 1) + ": ";
    EXPECT_TRUE(has(outcome.text, place)) << place << "\n" << outcome.text;
    const Outcome info = run("device info " + file, kShipped);
    EXPECT_EQ(info.exit_code, 2) << info.text;
    const size_t told = info.text.find(place);
    EXPECT_NE(told, std::string::npos) << info.text;
    EXPECT_EQ(info.text.find("expected", info.text.find("expected") + 1), std::string::npos) << "twice:\n" << info.text;
    return outcome.text;
  };
  EXPECT_TRUE(has(problem("rate: 1500", "rate: 900000"), "parameters.wire.rate: "));
  EXPECT_TRUE(has(problem("exchange: stream", "exchange: pull"), "\"pull\", expected one of stream, poll"));
  EXPECT_TRUE(has(problem("address: 0x100000", "address: 0x100001"), "expected a multiple of 64 KiB"));
}

TEST_F(DeviceCommands, DeviceControlsSaysWhichControlsOneArmHas) {
  const Outcome simulated =
      run("device controls " HAPTICD_SOURCE_DIR "/config/devices/simulated-premium15.yaml", kShipped);
  EXPECT_EQ(simulated.exit_code, 0) << simulated.text;
  EXPECT_TRUE(has(simulated.text, "simulated Premium 1.5: a simulated arm: it has no motors")) << simulated.text;
  EXPECT_TRUE(has(simulated.text, "8.5 N")) << simulated.text;
  const Outcome real = run("device controls " HAPTICD_SOURCE_DIR "/config/devices/woodenhaptics.yaml", kShipped);
  EXPECT_EQ(real.exit_code, 0) << real.text;
  for (const char* line :
       {"not plugged in", "speed between samples          false positions or times   5 m/s (H1 H2)",
        "off      the hardware's own watchdog", "on       force of an old sample", "fades after 2 ms"})
    EXPECT_TRUE(has(real.text, line)) << line << "\n" << real.text;
}

TEST_F(DeviceCommands, DeviceInfoPrintsTheParametersWhenAsked) {
  const std::string arm = put("arm.yaml", kArm);
  const Outcome plain = run("device info " + arm), full = run("device info --parameters " + arm);
  EXPECT_EQ(full.exit_code, 0) << full.text;
  EXPECT_FALSE(has(plain.text, " gain")) << plain.text;
  EXPECT_TRUE(has(full.text, " gain")) << full.text;
}

/// Returns the first numbers after a word of a text.
std::vector<double> numbersAfter(const std::string& text, const std::string& word, size_t count) {
  std::vector<double> numbers;
  for (size_t at = text.find(word) + word.size(); at < text.size() && numbers.size() < count;) {
    at = text.find_first_of("-0123456789", at);
    if (at == std::string::npos) break;
    size_t length = 0;
    numbers.push_back(std::stod(text.substr(at), &length));
    at += length;
  }
  return numbers;
}

TEST_F(DeviceCommands, DeviceInfoGivesProgramsTheReachThatItPrints) {
  const std::string arm = HAPTICD_SOURCE_DIR "/config/devices/simulated-premium15.yaml";
  const std::string plain = run("device info " + arm, kShipped).text;
  const std::string json = run("device info --json " + arm, kShipped).text;
  ASSERT_TRUE(has(plain, "reach of the tip") && has(json, "\"reach_m\"")) << plain << json;
  const auto printed = numbersAfter(plain, "reach of the tip in the device frame:", 6);
  const auto low = numbersAfter(json, "\"min\"", 3), high = numbersAfter(json, "\"max\"", 3);
  ASSERT_TRUE(printed.size() == 6 && low.size() == 3 && high.size() == 3) << plain << json;
  for (size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(low[axis], printed[2 * axis], 0.0006) << axis;
    EXPECT_NEAR(high[axis], printed[2 * axis + 1], 0.0006) << axis;
  }
}

TEST_F(DeviceCommands, DeviceInfoSaysWhatNobodyTriedAlthoughNothingIsPluggedIn) {
  for (const char* name : {"woodenhaptics", "polhem", "falcon", "sarcos"}) {
    const Outcome outcome =
        run("device info " HAPTICD_SOURCE_DIR "/config/devices/" + std::string(name) + ".yaml", kShipped);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
    EXPECT_TRUE(has(outcome.text, "not tried on hardware")) << outcome.text;
    EXPECT_TRUE(has(outcome.text, "gravity is not compensated")) << outcome.text;
  }
}

TEST_F(DeviceCommands, SaysOfAnArmBehindAVendorsLibraryWhatIsTrueOfIt) {
  const std::string arm =
      put("touch.yaml", "hapticd-device: 1\nmodule: vendor_hd\nname: touch\nparameters: {library: libNothing.so}\n");
  const Outcome info = run("device info " + arm, kShipped), doctor = run("doctor --seconds 0 " + arm, kShipped),
                twin = run("device twin " + arm, kShipped);
  EXPECT_TRUE(has(info.text, "(a vendor's library may): gravity is not compensated")) << info.text;
  EXPECT_FALSE(has(info.text, "masses")) << info.text;
  EXPECT_FALSE(has(info.text, "device.verified")) << "it has no such parameter:\n" << info.text;
  EXPECT_TRUE(has(doctor.text, "fix: install the vendor's driver")) << doctor.text;
  EXPECT_FALSE(has(doctor.text, "plug it in and switch it on")) << doctor.text;
  EXPECT_EQ(twin.exit_code, 2);
  EXPECT_TRUE(has(twin.text, "does not describe its mechanism")) << twin.text;
}

TEST_F(DeviceCommands, KinematicsWarnsOfJointsBeyondTheArmsLimits) {
  const std::string arm = HAPTICD_SOURCE_DIR "/config/devices/woodenhaptics.yaml";
  const Outcome inside =
      run("device kinematics " + arm + " --joints " + put("in.csv", "q1,q2,q3\n0,1,1.5\n"), kShipped);
  EXPECT_EQ(inside.exit_code, 0) << inside.text;
  EXPECT_FALSE(has(inside.text, "warning")) << inside.text;
  const Outcome outside =
      run("device kinematics " + arm + " --joints " + put("out.csv", "q1,q2,q3\n0,1,1.5\n1.6,1,1.5\n"), kShipped);
  EXPECT_EQ(outside.exit_code, 0) << outside.text;
  EXPECT_TRUE(has(outside.text, "in 1 of 2 rows the arm cannot reach the tip position within its joint limits"))
      << outside.text;
}

/// The number in a column of the one row of a CSV text.
double columnOf(const std::string& csv, const std::string& name) {
  std::istringstream names(csv.substr(0, csv.find('\n'))), row(csv.substr(csv.find('\n') + 1));
  std::string column, value;
  while (std::getline(names, column, ',') && std::getline(row, value, ','))
    if (column == name) return std::stod(value);
  return std::nan("");
}

TEST_F(DeviceCommands, RunRefusesAnEnableButtonThatNoReportHas) {
  const std::string folder = HAPTICD_SOURCE_DIR "/tests/scenes/first_hour/";
  const std::string gap = put("gap.yaml", [&] {
    std::ifstream in(folder + "61-enable-counts-from-0.yaml");
    std::string text((std::istreambuf_iterator<char>(in)), {});
    const size_t field = text.find("button: 1,"), key = text.find("enable: {button: 1");
    EXPECT_TRUE(field != std::string::npos && key != std::string::npos) << text;
    return text.replace(field, 10, "button: 2,").replace(key, 18, "enable: {button: 0");
  }());
  for (const std::string& arm : {folder + "61-enable-counts-from-0.yaml", folder + "62-enable-beyond.yaml",
                                 folder + "63-enable-without-a-button.yaml", gap}) {
    const Outcome outcome =
        run("run " HAPTICD_SOURCE_DIR "/config/scenes/sphere.yaml --for 0.1 --device " + arm, kShipped);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.text;
    EXPECT_TRUE(has(outcome.text, "(counted from 0), so forces could never be enabled")) << outcome.text;
  }
}

TEST_F(DeviceCommands, EveryArmThatShipsRestsBeforeTheShapesOfAScene) {
  const std::vector<std::array<std::string, 2>> at_rest = {
      {"woodenhaptics", "0,1.5707963267948966,1.5707963267948966"},
      {"polhem", "0,1.5707963267948966,1.5707963267948966"},
      {"premium15", "0,0,0"},
      {"premium15-bulk", "0,0,0"},
      {"falcon", "0.55,0.55,0.55"},
      {"sarcos", "-1.5707963267948966,2.2,0,-1.2,0,0,0,0,0.35,0"},
  };
  for (const auto& [name, joints] : at_rest) {
    const std::string arm = HAPTICD_SOURCE_DIR "/config/devices/" + name + ".yaml";
    const std::string names = std::string("q1,q2,q3") + (name == "sarcos" ? ",q4,q5,q6,q7,q8,q9,q10" : "");
    const std::string tip = (dir_ / "tip.csv").string();
    run("device kinematics " + arm + " --joints " + put("q.csv", names + "\n" + joints + "\n") + " -o " + tip,
        kShipped);
    const std::string info = run("device info " + arm, kShipped).text, csv = get("tip.csv");
    std::array<double, 3> mount{};
    const size_t at = info.find("position [");
    ASSERT_TRUE(at != std::string::npos &&
                std::sscanf(info.c_str() + at, "position [%lf, %lf, %lf]", &mount[0], &mount[1], &mount[2]) == 3)
        << info;
    EXPECT_NEAR(mount[0] + columnOf(csv, "x"), 0, 0.01) << name;
    EXPECT_NEAR(mount[1] + columnOf(csv, "y"), 0, 0.01) << name;
    EXPECT_NEAR(mount[2] + columnOf(csv, "z"), 0.07, 0.025) << name << ": 5 cm of the small Falcon to 9 cm";
  }
}

TEST_F(DeviceCommands, CheckWarnsOfCountsWithoutScaleAndOfAWorkspaceThatLeavesTheTipOut) {
  std::ifstream shipped(HAPTICD_SOURCE_DIR "/config/devices/woodenhaptics.yaml");
  std::string text{std::istreambuf_iterator<char>(shipped), {}};
  const auto replace = [&text](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  const Outcome good = run("check " + put("arm.yaml", text), kShipped);
  EXPECT_FALSE(has(good.text, "warning")) << good.text;
  replace("scale: -1.9634954084936207e-4, ", "");
  replace("limits: {force: 5,", "limits: {force: 9, workspace: 0.2,");
  const Outcome outcome = run("check " + put("arm.yaml", text), kShipped);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "input.fields[0].scale: warning: not given, so each count of this i16 is 1 rad"))
      << outcome.text;
  EXPECT_TRUE(has(outcome.text, "limits.workspace: warning: 0.2 m from the origin of the arm's frame")) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "0.452 m away")) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "9 N is more than the arm's")) << outcome.text;
  replace("workspace: 0.2", "workspace: 0.6");
  EXPECT_FALSE(has(run("check " + put("arm.yaml", text), kShipped).text, "limits.workspace"));
}

}  // namespace
}  // namespace hapticd::test
