// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>

#include "commands_fixture.hpp"

namespace hapticd::test {
namespace {

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

TEST_F(Commands, EverySubcommandHasHelpWithAnExample) {
  for (const char* command :
       {"", "check", "run", "trace", "explain", "doctor", "import", "plugin", "plugin list", "plugin info",
        "plugin new", "part", "part info", "device", "device list", "device info", "device kinematics"}) {
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
  EXPECT_TRUE(has(run("run").text, "error: scene is missing, expected `hapticd run SCENE`; see hapticd run --help"));
  EXPECT_TRUE(has(run("check x.yaml --schema sceen").text, "(did you mean \"scene\"?)"));
}

TEST_F(Commands, ADaemonFileThatIsMissingIsTheOnlyProblem) {
  const Outcome outcome = run("--config nosuch.yaml run " + put("scene.yaml", kScene) + " --for 0.1");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "nosuch.yaml:1:1: there is no such file")) << outcome.text;
  EXPECT_FALSE(has(outcome.text, "exit()")) << outcome.text;
}

TEST_F(Commands, ANumberThatIsNoneIsOutOfEveryRange) {
  for (const char* command :
       {"run x.yaml --virtual-time --for nan", "run x.yaml --rate nan", "tune x.yaml --motion-seconds nan",
        "tune x.yaml --tolerance-um nan", "import x.bpt y.yaml --scale nan", "import x.bpt y.yaml --fit nan",
        "import x.obj y.ma --medial --tolerance nan", "import x.obj y.ma --medial --angle nan",
        "ctl geometry x --tolerance nan", "doctor --seconds nan"}) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 2) << command;
    EXPECT_TRUE(has(outcome.text, "nan is out of range")) << command << outcome.text;
  }
}

TEST_F(Commands, AProcessorThatIsNotThereIsRefused) {
  const Outcome outcome = run("run " + put("scene.yaml", kScene) + " --for 0.1 --cpu 1023");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "this machine has no processor 1023, expected 0")) << outcome.text;
  EXPECT_TRUE(has(run("run " + put("scene.yaml", kScene) + " --cpu 0.5").text, "\"0.5\" is not a whole number"));
  EXPECT_FALSE(has(run("run --help").text, "1023"));
  // A daemon file may come from another machine, so the run goes on.
  const std::string daemon = put("daemon.yaml", "hapticd-daemon: 1\nservo: {cpu: 1023}\n");
  put("arm.yaml", kArm);
  const Outcome warned = run("--config " + daemon + " run " + put("scene.yaml", kScene) + " --for 0.1");
  EXPECT_TRUE(has(warned.text, "fix: one of 0 to ") && has(warned.text, "ticks in 0.10 s")) << warned.text;
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

TEST_F(Commands, AnAbsentSceneNamesTheOneThatWasMeant) {
  put("teapot-mine.yaml", kScene);
  for (const char* command : {"run ", "check ", "explain "}) {
    const Outcome outcome = run(command + (dir_ / "teapot_mine.yaml").string());
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_TRUE(has(outcome.text, "expected the path of a file (did you mean \"teapot-mine.yaml\"?)")) << outcome.text;
  }
  for (const char* name : {"teapot", "teapot.yaml", "elsewhere/teapot.yaml"})
    EXPECT_TRUE(has(run(std::string("run ") + name, kShipped).text,
                    "\n  fix: a scene of this name ships: " HAPTICD_SOURCE_DIR "/config/scenes/teapot.yaml\n"));
  EXPECT_FALSE(has(run("run teapod").text, "ships"));
  const Outcome mesh = run("run " + put("part.stl", "solid part\nendsolid\n"));
  EXPECT_TRUE(has(mesh.text, "for nurbs_rigid (--scene SCENE.yaml writes such a scene)")) << mesh.text;
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
  EXPECT_TRUE(has(run("check " + bad).text, "2 problems in 1 file"));
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

TEST_F(Commands, CheckTellsAWrongFileWhereItIsNamed) {
  const std::string file = put("bad.yaml", "format: hapticd-model/1\nsurfaces: 3\n");
  const std::string scene =
      put("scene.yaml",
          "hapticd: 1\nmodels:\n  - {name: a, plugin: nurbs_rigid, parameters: {geometry: bad.yaml}}\n"
          "  - {name: b, plugin: nurbs_rigid, parameters: {geometry: none.yaml}}\n");
  const Outcome outcome = run("check " + scene);
  EXPECT_EQ(outcome.exit_code, 2);
  const std::string wrong = ":3:59: models[0].parameters.geometry: model 'a': cannot be set up: " + file + ":2:11: ";
  EXPECT_TRUE(has(outcome.text, scene + wrong)) << outcome.text;
  EXPECT_TRUE(has(outcome.text, scene + ":4:59: models[1].parameters.geometry: there is no file")) << outcome.text;
}

TEST_F(Commands, CheckPassesOnWhatAPluginWarnsOf) {
  const std::string scene = put("shell.yaml",
                                "hapticd: 1\nmodels:\n  - {name: a, plugin: nurbs_rigid, parameters: {pop_through: 2, "
                                "geometry: " HAPTICD_SOURCE_DIR "/config/models/sphere.yaml}}\n");
  const Outcome outcome =
      run("check " + scene, "HAPTICD_PLUGIN_PATH=" HAPTICD_BINARY_DIR "/" HAPTICD_MODULES "/plugins");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(has(outcome.text, scene + ":3:62: models[0].parameters.pop_through: warning: has no effect"))
      << outcome.text;
}

TEST_F(Commands, SchemasAreJsonWithThePluginsParameters) {
  const Outcome scene = run("check --schema scene");
  EXPECT_EQ(scene.exit_code, 0);
  EXPECT_TRUE(has(scene.text, "\"test_shape\"")) << scene.text;
  EXPECT_TRUE(has(scene.text, "Wall stiffness. [N/m]"));
  EXPECT_TRUE(has(run("check --schema device").text, "\"test_device\""));
  EXPECT_TRUE(has(run("check --schema daemon").text, "plugin_path"));
}

constexpr int kModels = 2000;  // run_as_a_user tries 10,000

TEST_F(Commands, ThousandsOfModelsAreReadInOneGo) {
  std::string text = "hapticd: 1\nmodels:\n";
  for (int i = 0; i < kModels; ++i)
    text += "  - {name: m" + std::to_string(i) + ", plugin: test_shape, parameters: {radius: 0.05}}\n";
  EXPECT_EQ(run("check -q " + put("many.yaml", text)).exit_code, 0);
  const Outcome refused = run("check " + put("wrong.yaml", text + "  - {name: m0, plugin: test_shape}\n"));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(has(refused.text, "wrong.yaml:2003:12: models[2000].name: \"m0\" is the name of another model (line 3)"));
}

TEST_F(Commands, ThousandsOfModelsOfAnUnknownPluginGiveShortMessages) {
  std::string text = "hapticd: 1\nmodels:\n";
  for (int i = 0; i < kModels; ++i) text += "  - {name: m" + std::to_string(i) + ", plugin: nothing}\n";
  const Outcome outcome = run("check " + put("unknown.yaml", text));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_LT(outcome.text.size(), 600'000u);
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

TEST_F(Commands, PluginNewMakesShapesInCAndShapesThatMoveWhichPassTheirTests) {
  for (const auto& [name, option, compiler, file] : {std::array{"my_c_ball", "--language c", "gcc", "my_c_ball.c"},
                                                     std::array{"my_plate", "--moving", HAPTICD_CXX, "my_plate.cpp"}}) {
    const std::string folder = (dir_ / name).string();
    const Outcome made = run(std::string("plugin new ") + name + " " + option + " --dir " + folder);
    ASSERT_EQ(made.exit_code, 0) << made.text;
    const size_t line = made.text.find("build it:  g");
    ASSERT_NE(line, std::string::npos) << made.text;
    const std::string command = compiler + made.text.substr(line + 14, made.text.find('\n', line) - line - 14);
    ASSERT_EQ(std::system((command + " -Wall -Wextra -Werror").c_str()), 0) << command;
    const Outcome tested = run("plugin check " + folder + "/" + name + ".so");
    EXPECT_EQ(tested.exit_code, 0) << tested.text;
    EXPECT_TRUE(has(tested.text, ", 0 failed")) << tested.text;
    EXPECT_FALSE(has(tested.text, "warn")) << tested.text;
    const Outcome check = run("--plugin-path " + folder + " check " + folder + "/scene.yaml");
    EXPECT_EQ(check.exit_code, 0) << check.text;
    EXPECT_TRUE(has(check.text, "scene.yaml: ok")) << check.text;
    const std::string texts = get(std::string(name) + "/" + file) + get(std::string(name) + "/CMakeLists.txt") +
                              get(std::string(name) + "/README.md");
    EXPECT_FALSE(has(texts, "emplate")) << texts;
    EXPECT_TRUE(has(texts, std::string("Made with `hapticd plugin new ") + option + "`.")) << texts;
  }
  EXPECT_EQ(run("plugin new other --language c --moving --dir " + (dir_ / "other").string()).exit_code, 2);
  EXPECT_EQ(run("plugin new other --language rust --dir " + (dir_ / "other").string()).exit_code, 2);
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
  EXPECT_TRUE(has(outcome.text, "scene.yaml:3 models with surfaces")) << outcome.text;
  EXPECT_FALSE(has(outcome.text, "it is static")) << outcome.text;
}

TEST_F(Commands, CheckNamesTheJointThatKeepsTheTipFromAModel) {
  const Outcome told =
      run("check " + put("scene.yaml",
                         "hapticd: 1\nhand: {script: press, center: [0, 0, -0.09], radius: 0, rise: 0.02}\n"
                         "models:\n  - {name: ball, plugin: nurbs_rigid, pose: {position: [0, 0, -0.1]}, "
                         "parameters: {geometry: " HAPTICD_SOURCE_DIR "/config/models/sphere.yaml}}\n"),
          kShipped);
  EXPECT_TRUE(has(told.text, "joint 3 is at the end of its range there, so the tip cannot follow the hand"))
      << told.text;
}

TEST_F(Commands, ARunThatCannotBeginLeavesNoRecording) {
  const std::string file = (dir_ / "run.h5").string();
  const std::string scene = put("far.yaml", "hapticd: 1\nhand: {center: [0, 3, 0]}\nmodels: []\n");
  const Outcome ran = run("run " + scene + " --for 1 --virtual-time --record " + file, kShipped);
  EXPECT_EQ(ran.exit_code, 1) << ran.text;
  EXPECT_TRUE(has(ran.text, "which the arm cannot reach")) << ran.text;
  EXPECT_FALSE(std::filesystem::exists(file)) << "it would look like that of a killed run";
}

TEST_F(Commands, ARunThatCannotBeginLeavesTheFormerRecordingAsItWas) {
  const std::string file = (dir_ / "run.h5").string(), models = "models: []\n";
  const std::string good = put("good.yaml", "hapticd: 1\nhand: {script: none}\n" + models);
  const std::string far = put("far.yaml", "hapticd: 1\nhand: {center: [0, 3, 0]}\n" + models);
  ASSERT_EQ(run("run " + good + " --for 0.1 --virtual-time --record " + file, kShipped).exit_code, 0);
  const auto before = std::filesystem::file_size(file);
  EXPECT_EQ(run("run " + far + " --for 1 --virtual-time --record " + file, kShipped).exit_code, 1);
  ASSERT_TRUE(std::filesystem::exists(file));
  EXPECT_EQ(std::filesystem::file_size(file), before);
  const Outcome replayed = run("replay " + file, kShipped);
  EXPECT_EQ(replayed.exit_code, 0) << replayed.text;
  EXPECT_EQ(run("run " + good + " --for 9 --virtual-time --record " + file, kShipped).exit_code, 0);
  EXPECT_GT(std::filesystem::file_size(file), before) << "a run that begins replaces it";
}

TEST_F(Commands, DaemonFileIsCheckedBeforeAnythingRuns) {
  const std::string daemon = put("daemon.yaml", "hapticd-daemon: 1\nservo: {priority: 200}\n");
  const Outcome outcome = run("--config " + daemon + " plugin list");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(has(outcome.text, "daemon.yaml:2:19: servo.priority: 200 is out of range")) << outcome.text;
}

}  // namespace
}  // namespace hapticd::test
