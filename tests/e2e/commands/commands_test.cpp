// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "run_program.hpp"

namespace hapticd::test {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test.
class Commands : public testing::Test {
 protected:
  void SetUp() override {
    dir_ = fs::temp_directory_path() / ("hapticd-commands-" + std::to_string(::getpid()));
    fs::create_directories(dir_);
  }
  void TearDown() override { fs::remove_all(dir_); }
  std::string put(const std::string& name, const std::string& text) {
    std::ofstream(dir_ / name) << text;
    return (dir_ / name).string();
  }
  std::string get(const std::string& name) {
    std::stringstream text;
    text << std::ifstream(dir_ / name).rdbuf();
    return text.str();
  }
  fs::path dir_;
};

constexpr const char* kScene =
    "hapticd: 1\n"
    "servo: {rate: 2000}\n"
    "device: arm.yaml\n"
    "hand: {mass: 0.3}\n"
    "models:\n"
    "  - name: ball\n"
    "    plugin: test_shape\n"
    "    pose: {orientation: [1.0005, 0, 0, 0]}\n"
    "    parameters: {radius: 0.05, detent: [[0, 1], [2, 3]], inner: {mass: 2}}\n";
/// The modules that ship, not those of tests alone.
constexpr const char* kShipped = "HAPTICD_PLUGIN_PATH=" HAPTICD_BINARY_DIR "/" HAPTICD_MODULES "/devices";
constexpr const char* kArm = "hapticd-device: 1\nmodule: test_device\nhand: {mass: 0.2}\n";

TEST_F(Commands, EverySubcommandHasHelpWithAnExample) {
  for (const char* command :
       {"", "check", "run", "trace", "explain", "doctor", "import", "plugin", "plugin list", "plugin info",
        "plugin new", "device", "device list", "device info", "device kinematics"}) {
    const Outcome outcome = run(std::string(command) + " --help");
    EXPECT_EQ(outcome.exit_code, 0) << command << outcome.text;
    EXPECT_TRUE(has(outcome.text, "Example")) << command << outcome.text;
  }
}

TEST_F(Commands, BadUsageEndsWithTwo) {
  for (const char* command :
       {"", "frobnicate", "check", "check --nonsense x", "run", "run nowhere.yaml --for -1", "plugin", "plugin info",
        "device kinematics x.yaml", "import x.bpt", "check --schema opera"})
    EXPECT_EQ(run(command).exit_code, 2) << command;
  EXPECT_TRUE(has(run("chekc x.yaml").text, "did you mean \"check\"?"));
}

TEST_F(Commands, ANumberThatIsNoneIsOutOfEveryRange) {
  for (const char* command :
       {"run x.yaml --virtual-time --for nan", "run x.yaml --rate nan", "tune x.yaml --motion-seconds nan",
        "tune x.yaml --tolerance-um nan", "import x.bpt y.yaml --scale nan", "import x.bpt y.yaml --fit nan",
        "import x.obj y.ma --medial --tolerance nan", "import x.obj y.ma --medial --angle nan",
        "ctl geometry x --tolerance nan", "doctor --seconds nan"}) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 2) << command;
    EXPECT_TRUE(has(outcome.text, "nan not in range")) << command << outcome.text;
  }
}

TEST_F(Commands, VersionIsOneLine) {
  const Outcome outcome = run("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.text.rfind("hapticd ", 0), 0u) << outcome.text;
}

TEST_F(Commands, CheckAcceptsAGoodSceneAndDevice) {
  const std::string arm = put("arm.yaml", kArm), scene = put("scene.yaml", kScene);
  const Outcome outcome = run("check " + scene + " " + arm);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_EQ(outcome.text, scene + ": ok\n" + arm + ": ok\n");
}

TEST_F(Commands, CheckPrintsTheProblemsOfEveryFileAndGoesOn) {
  const std::string good = put("arm.yaml", kArm), bad = put("bad.yaml", "hapticd: 1\nmodels: 3\nx: 1\n");
  const Outcome outcome = run("check " + bad + " " + (dir_ / "missing.yaml").string() + " " + good);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(has(outcome.text, bad + ":2:9: models: ")) << outcome.text;
  EXPECT_TRUE(has(outcome.text, bad + ":3:1: x: unknown key")) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "missing.yaml:1:1: there is no such file")) << outcome.text;
  EXPECT_TRUE(has(outcome.text, good + ": ok")) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "3 problems in 2 of 3 files")) << outcome.text;
}

TEST_F(Commands, CheckTellsWhatOnlyThePluginKnows) {
  const std::string scene = put("scene.yaml",
                                "hapticd: 1\nmodels:\n  - {name: a, plugin: test_shape, parameters: {radius: 0.05}}\n"
                                "  - {name: b, plugin: test_shape, parameters: {radius: 0.05, label: refuse}}\n"
                                "  - {name: c, plugin: test_shape, parameters: {radius: 0.05, label: nonsense}}\n");
  const Outcome outcome = run("check " + scene);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(has(outcome.text, scene + ":4:5: models[1]: model 'b': cannot be set up: the label is")) << outcome.text;
  EXPECT_TRUE(has(outcome.text, scene + ":5:5: models[2]: model 'c': its report claims")) << outcome.text;
  EXPECT_EQ(run("check --files-only " + scene).exit_code, 0);
}

TEST_F(Commands, CheckPassesOnWhatAPluginWarnsOf) {
  const std::string scene = put("shell.yaml",
                                "hapticd: 1\nmodels:\n  - {name: a, plugin: nurbs_rigid, parameters: {pop_through: 2, "
                                "geometry: " HAPTICD_SOURCE_DIR "/config/models/sphere.yaml}}\n");
  const Outcome outcome =
      run("check " + scene, "HAPTICD_PLUGIN_PATH=" HAPTICD_BINARY_DIR "/" HAPTICD_MODULES "/plugins");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(has(outcome.text, scene + ":3:5: models[0]: warning: pop_through has no effect")) << outcome.text;
}

TEST_F(Commands, SchemasAreJsonWithThePluginsParameters) {
  const Outcome scene = run("check --schema scene");
  EXPECT_EQ(scene.exit_code, 0);
  EXPECT_TRUE(has(scene.text, "\"test_shape\"")) << scene.text;
  EXPECT_TRUE(has(scene.text, "Wall stiffness. [N/m]"));
  EXPECT_TRUE(has(run("check --schema device").text, "\"test_device\""));
  EXPECT_TRUE(has(run("check --schema daemon").text, "plugin_path"));
}

TEST_F(Commands, TenThousandModelsAreReadInOneGo) {
  std::string text = "hapticd: 1\nmodels:\n";
  for (int i = 0; i < 10000; ++i)
    text += "  - {name: m" + std::to_string(i) + ", plugin: test_shape, parameters: {radius: 0.05}}\n";
  EXPECT_EQ(run("check -q " + put("many.yaml", text)).exit_code, 0);
  const Outcome refused = run("check " + put("wrong.yaml", text + "  - {name: m0, plugin: test_shape}\n"));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(
      has(refused.text, "wrong.yaml:10003:12: models[10000].name: \"m0\" is the name of another model (line 3)"));
}

TEST_F(Commands, TenThousandModelsOfAnUnknownPluginGiveShortMessages) {
  std::string text = "hapticd: 1\nmodels:\n";
  for (int i = 0; i < 10000; ++i) text += "  - {name: m" + std::to_string(i) + ", plugin: nothing}\n";
  const Outcome outcome = run("check " + put("unknown.yaml", text));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_LT(outcome.text.size(), 3'000'000u);
  EXPECT_TRUE(has(outcome.text, "(see line 3)"));
}

TEST_F(Commands, PluginListShowsGoodAndBadFiles) {
  const Outcome outcome = run("plugin list --files");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(has(outcome.text, "test_shape         1.2.3    One parameter of every kind.")) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "crash.so: while it was loaded it crashed: Segmentation fault")) << outcome.text;
}

TEST_F(Commands, PluginInfoDocumentsUnitRangeAndDefault) {
  const Outcome outcome = run("plugin info test_shape");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(has(outcome.text, "number, 0 to 20000 N/m; default 500")) << outcome.text;
  const Outcome unknown = run("plugin info test_shap");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(has(unknown.text, "did you mean \"test_shape\"?")) << unknown.text;
  EXPECT_TRUE(has(unknown.text, "searched:")) << unknown.text;
}

TEST_F(Commands, PluginNewMakesAPluginThatBuildsUnderItsName) {
  const std::string folder = (dir_ / "my_ball").string();
  const Outcome made = run("plugin new my_ball --dir " + folder);
  ASSERT_EQ(made.exit_code, 0) << made.text;
  const size_t line = made.text.find("build it:  g++ ");
  ASSERT_NE(line, std::string::npos) << made.text;  // the first line that it prints works as it stands
  const std::string command = HAPTICD_CXX + made.text.substr(line + 14, made.text.find('\n', line) - line - 14);
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  const Outcome info = run("--plugin-path " + folder + " plugin info my_ball");
  EXPECT_EQ(info.exit_code, 0) << info.text;
  EXPECT_TRUE(has(info.text, "org.example.shape.my_ball")) << info.text;
  const Outcome check = run("--plugin-path " + folder + " check " + folder + "/scene.yaml");
  EXPECT_EQ(check.exit_code, 0) << check.text;
  EXPECT_FALSE(has(get("my_ball/my_ball.cpp") + get("my_ball/CMakeLists.txt"), "emplate"));
  EXPECT_EQ(run("plugin new my_ball --dir " + folder).exit_code, 2);
  for (const char* name : {"My", "a-b", "../x", "1a", "template"})
    EXPECT_EQ(run(std::string("plugin new ") + name).exit_code, 2) << name;
}

TEST_F(Commands, DeviceListAndInfoTellTheFacts) {
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

TEST_F(Commands, KinematicsGivesPoseJacobianAndTorques) {
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

TEST_F(Commands, CheckPlacesWhatADeviceModuleRefusesInTheFile) {
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

TEST_F(Commands, DeviceControlsSaysWhichControlsOneArmHas) {
  const Outcome simulated =
      run("device controls " HAPTICD_SOURCE_DIR "/config/devices/simulated-premium15.yaml", kShipped);
  EXPECT_EQ(simulated.exit_code, 0) << simulated.text;
  EXPECT_TRUE(has(simulated.text, "simulated Premium 1.5: plugged in")) << simulated.text;
  EXPECT_TRUE(has(simulated.text, "8.5 N")) << simulated.text;
  const Outcome real = run("device controls " HAPTICD_SOURCE_DIR "/config/devices/woodenhaptics.yaml", kShipped);
  EXPECT_EQ(real.exit_code, 0) << real.text;
  for (const char* line :
       {"not plugged in", "speed between samples          false positions or times   5 m/s (H1 H2)",
        "off      the hardware's own watchdog", "on       force of an old sample", "fades after 2 ms"})
    EXPECT_TRUE(has(real.text, line)) << line << "\n" << real.text;
}

TEST_F(Commands, DeviceInfoPrintsTheParametersWhenAsked) {
  const std::string arm = put("arm.yaml", kArm);
  const Outcome plain = run("device info " + arm), full = run("device info --parameters " + arm);
  EXPECT_EQ(full.exit_code, 0) << full.text;
  EXPECT_FALSE(has(plain.text, " gain")) << plain.text;
  EXPECT_TRUE(has(full.text, " gain")) << full.text;
}

TEST_F(Commands, DeviceInfoSaysWhatNobodyTriedAlthoughNothingIsPluggedIn) {
  for (const char* name : {"woodenhaptics", "polhem"}) {
    const Outcome outcome =
        run("device info " HAPTICD_SOURCE_DIR "/config/devices/" + std::string(name) + ".yaml", kShipped);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
    EXPECT_TRUE(has(outcome.text, "not tried on hardware")) << outcome.text;
    EXPECT_TRUE(has(outcome.text, "gravity is not compensated")) << outcome.text;
  }
}

TEST_F(Commands, KinematicsWarnsOfJointsBeyondTheArmsLimits) {
  const std::string arm = HAPTICD_SOURCE_DIR "/config/devices/woodenhaptics.yaml";
  const Outcome inside =
      run("device kinematics " + arm + " --joints " + put("in.csv", "q1,q2,q3\n0,1,1.5\n"), kShipped);
  EXPECT_EQ(inside.exit_code, 0) << inside.text;
  EXPECT_FALSE(has(inside.text, "warning")) << inside.text;
  const Outcome outside =
      run("device kinematics " + arm + " --joints " + put("out.csv", "q1,q2,q3\n0,1,1.5\n1.6,1,1.5\n"), kShipped);
  EXPECT_EQ(outside.exit_code, 0) << outside.text;
  EXPECT_TRUE(has(outside.text, "in 1 of 2 rows the tip is beyond the arm's joint limits")) << outside.text;
}

/// The number in a column of the one row of a CSV text.
double columnOf(const std::string& csv, const std::string& name) {
  std::istringstream names(csv.substr(0, csv.find('\n'))), row(csv.substr(csv.find('\n') + 1));
  std::string column, value;
  while (std::getline(names, column, ',') && std::getline(row, value, ','))
    if (column == name) return std::stod(value);
  return std::nan("");
}

TEST_F(Commands, EveryArmThatShipsRestsBeforeTheShapesOfAScene) {
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

TEST_F(Commands, ImportScalesCentresAndKeepsTheCredit) {
  const std::string patch = put("patch.bpt", "# By somebody\n1\n1 1\n0 0 0\n0 0 2\n4 0 0\n4 0 2\n");
  const Outcome outcome = run("import " + patch + " --scale 0.5 --center -o " + (dir_ / "model.yaml").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_EQ(get("model.yaml"),
            "# By somebody\nformat: hapticd-model/1\nsurfaces:\n  - name: patch0\n    degree: [1, 1]\n"
            "    knots: [[0, 0, 1, 1], [0, 0, 1, 1]]\n"
            "    points: [[-1, 0, -0.5], [-1, 0, 0.5],\n             [1, 0, -0.5], [1, 0, 0.5]]\n");
  EXPECT_EQ(run("import " + patch + " -o /nowhere/at/all.yaml").exit_code, 1);
}

TEST_F(Commands, ImportSaysWhereAPatchFileIsWrong) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "ends early, expected the number of patches"},
      {"1\n3 3\n0 0 0\n", "ends early, expected a coordinate"},
      {"1\n99 3\n", "bad.bpt:2:1: 99, expected a degree"},
      {"1\n1 1\n0 0 0\n0 x 2\n", "bad.bpt:4:3: x, expected a coordinate"},
      {"1\n1 1\n0 0 0\n0 0 2\n4 0 0\n4 0 2\n7\n", "bad.bpt:7:1: 7, expected the end"},
      {"999999999\n", "expected the number of patches, 1 to 100000"},
  };
  for (const auto& [text, reason] : cases) {
    const Outcome outcome = run("import " + put("bad.bpt", text) + " -o " + (dir_ / "x.yaml").string());
    EXPECT_EQ(outcome.exit_code, 2) << text;
    EXPECT_TRUE(has(outcome.text, reason)) << outcome.text;
  }
}

TEST_F(Commands, ImportMakesAPartOfTriangles) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", part = (dir_ / "egg.hpart").string();
  const std::string mesh = put("egg.obj", triangle);
  const Outcome wrong = run("import " + mesh + " -o " + (dir_ / "egg.yaml").string());
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(has(wrong.text, "triangles become a part, expected a name that ends in .hpart")) << wrong.text;
  const Outcome made = run("import " + mesh + " --scale 0.1 -o " + part);
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_TRUE(has(made.text, "1 triangles, 3 points, 0.1 x 0.1 x 0 m, open")) << made.text;
  EXPECT_TRUE(has(made.text, "1 hole with 3 free edges")) << made.text;
  const Outcome info = run("part info " + part);
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_TRUE(has(info.text, "body 'egg': mesh, open, 1 triangles")) << info.text;
  EXPECT_EQ(run("part info " + mesh).exit_code, 2);
}

TEST_F(Commands, CheckSaysWhatAPartCannotDo) {
  const std::string part = (dir_ / "egg.hpart").string();
  ASSERT_EQ(run("import " + put("egg.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n") + " -o " + part).exit_code, 0);
  const auto check = [&](const std::string& plugin, const std::string& parameters) {
    return run("check " + put("scene.yaml", "hapticd: 1\nmodels:\n  - {name: egg, plugin: " + plugin +
                                                ", parameters: {geometry: egg.hpart" + parameters + "}}\n"),
               kShipped);
  };
  EXPECT_EQ(check("nurbs_rigid", "").exit_code, 0) << check("nurbs_rigid", "").text;
  EXPECT_TRUE(has(check("nurbs_rigid", ", method: dpt").text, "a part is searched as a whole in every tick"));
  EXPECT_TRUE(has(check("nurbs_rigid", ", instance: lid").text, "there is no 'lid', expected one of egg"));
  EXPECT_TRUE(has(check("nurbs_rigid", ", sides: front").text, "bounds no volume"));
  EXPECT_TRUE(has(check("push_button", "").text, "is a part; expected a model file here"));
}

TEST_F(Commands, ExplainNamesTheVelocityEstimatorAsTheSceneDoes) {
  const std::string scene = put("scene.yaml",
                                "hapticd: 1\nservo: {velocity: {estimator: window, parameter: 3}}\nmodels:\n"
                                "  - {name: ball, plugin: nurbs_rigid, parameters: {geometry: " HAPTICD_SOURCE_DIR
                                "/config/models/sphere.yaml, damping: 5}}\n");
  const Outcome outcome = run("explain " + scene, kShipped);
  EXPECT_TRUE(has(outcome.text, "window (3): a model uses velocity")) << outcome.text;
}

TEST_F(Commands, ExplainNamesWhatMovesAKinematicModel) {
  const std::string path = put("path.csv", "t,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0.01,0,1,0,0,0\n");
  const std::string scene =
      put("scene.yaml",
          "hapticd: 1\nmodels:\n  - name: led\n    plugin: nurbs_rigid\n    motion: kinematic\n"
          "    path: path.csv\n    parameters: {geometry: " HAPTICD_SOURCE_DIR "/config/models/sphere.yaml}\n");
  const Outcome outcome = run("explain --cost " + scene, kShipped);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "it follows the 2 points of its path")) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "models[0].path")) << outcome.text;
  EXPECT_FALSE(has(outcome.text, "it is static")) << outcome.text;
}

TEST_F(Commands, CheckWarnsOfCountsWithoutScaleAndOfAWorkspaceThatLeavesTheTipOut) {
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

TEST_F(Commands, DaemonFileIsCheckedBeforeAnythingRuns) {
  const std::string daemon = put("daemon.yaml", "hapticd-daemon: 1\nservo: {priority: 200}\n");
  const Outcome outcome = run("--config " + daemon + " plugin list");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(has(outcome.text, "daemon.yaml:2:19: servo.priority: 200 is out of range")) << outcome.text;
}

}  // namespace
}  // namespace hapticd::test
