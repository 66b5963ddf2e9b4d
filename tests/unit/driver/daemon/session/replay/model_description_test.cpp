// SPDX-License-Identifier: MIT
/// What a recording says of a model that comes is enough to build it again, or says that it is not.
#include "session/replay/model_description.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "record/scene_json.hpp"

namespace hapticd::servo {
namespace {

constexpr size_t kRoom = 100'000;

hsp_class pluginOf(const char* version) {
  hsp_class plugin{};
  plugin.id = "org.hapticd.shape.nurbs_rigid";
  plugin.version = version;
  return plugin;
}

scene::Value geometryAt(const std::string& file) {
  scene::Value value;
  value.id = "geometry";
  value.kind = HSP_PATH;
  value.text = file;
  return value;
}

/// A model on a path of this many points, with a file.
scene::Model modelOnPath(const std::string& file, int points) {
  scene::Model model;
  model.name = "w\xc3\xa4ll";
  model.plugin = "nurbs_rigid";
  model.library = "plugin.so";
  model.pose.position = {0.1, 1.0 / 3, -7e-300};
  model.kinematic = true;
  model.enabled = false;
  for (int i = 0; i < points; ++i) model.path.push_back({i * 0.1, {{0, i / 3.0, 0}, Eigen::Quaterniond::Identity()}});
  model.parameters = {geometryAt(file)};
  return model;
}

class ModelDescriptionTest : public testing::Test {
 protected:
  ModelDescriptionTest() { std::ofstream(file_) << "a"; }
  ~ModelDescriptionTest() override { std::remove(file_.c_str()); }
  std::string file_ = testing::TempDir() + "described" + std::to_string(getpid());
};

TEST_F(ModelDescriptionTest, GivesTheModelAndTheContentOfItsFiles) {
  scene::Model named = modelOnPath("name of the asking program", 3);
  named.path[1].pose.orientation = {0.6, 0, -0.8, 1.0 / 3};
  named.path[2].pose.orientation = {1, -0.0, 0, 0};
  const std::string text = describeModel(named, modelOnPath(file_, 3), pluginOf("1.1"), kRoom);
  EXPECT_TRUE(std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c < 127; })) << text;
  const auto read = readModelDescription(text);
  ASSERT_TRUE(read) << read.error();
  EXPECT_TRUE(read->whole);
  EXPECT_EQ(record::modelToJson(read->model), record::modelToJson(named)) << "every bit";
  ASSERT_EQ(read->files.size(), 2u);
  EXPECT_EQ(read->files[0].path, "plugin.so");
  EXPECT_EQ(read->files[1].path, "name of the asking program");
  EXPECT_EQ(read->files[1].hash, "af63dc4c8601ec8c") << "FNV-1a of \"a\", from its specification";
}

TEST_F(ModelDescriptionTest, SaysWhenItIsNotWhole) {
  const scene::Model model = modelOnPath(file_, 1000);
  const auto without_path = readModelDescription(describeModel(model, model, pluginOf("1.1"), 2000));
  ASSERT_TRUE(without_path) << without_path.error();
  EXPECT_FALSE(without_path->whole);
  EXPECT_TRUE(without_path->model.path.empty());
  EXPECT_EQ(without_path->model.parameters.size(), 1u);
  const auto least = readModelDescription(describeModel(model, model, pluginOf("1.1"), 10));
  ASSERT_TRUE(least) << least.error();
  EXPECT_FALSE(least->whole);
  EXPECT_EQ(least->model.name, model.name);
  EXPECT_TRUE(least->model.parameters.empty());
}

/// As for the models of the scene: the default of that version is taken, not that of today.
TEST_F(ModelDescriptionTest, TakesTheDefaultsOfTheVersionThatRan) {
  const scene::Model model = modelOnPath(file_, 0);
  const auto former = readModelDescription(describeModel(model, model, pluginOf("1.0"), kRoom));
  ASSERT_TRUE(former) << former.error();
  EXPECT_NE(scene::givenIn(former->model.parameters, "contact_hysteresis"), nullptr);
  const auto today = readModelDescription(describeModel(model, model, pluginOf("1.1"), kRoom));
  ASSERT_TRUE(today) << today.error();
  EXPECT_EQ(scene::givenIn(today->model.parameters, "contact_hysteresis"), nullptr);
}

TEST_F(ModelDescriptionTest, RefusesWhatIsDamaged) {
  const scene::Model model = modelOnPath(file_, 0);
  const std::string text = describeModel(model, model, pluginOf("1.1"), kRoom);
  for (size_t bytes = 0; bytes < text.size(); bytes += 7)
    EXPECT_FALSE(readModelDescription(text.substr(0, bytes))) << bytes;
  for (const char* key : {"\"files\":[", "\"version\":", "\"hash\":"}) {
    std::string wrong = text;
    const size_t at = wrong.find(key);
    ASSERT_NE(at, std::string::npos) << key;
    wrong.insert(at + std::string(key).size(), "7,\"x\":");
    EXPECT_FALSE(readModelDescription(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace hapticd::servo
