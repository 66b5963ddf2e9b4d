// SPDX-License-Identifier: MIT
/// Each number of a recording means the model that had it in that tick, also where rows are missing or damaged.
#include "session/replay/run_models.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "record/recording_file.hpp"
#include "record/scene_json.hpp"
#include "servo/core/order.hpp"
#include "session/replay/model_description.hpp"
#include "session/telemetry/flight.hpp"

namespace hapticd::servo {
namespace {

using record::ColumnType;

constexpr size_t kText = Order::kTextBytes - 1;

record::StreamSpec marksSpec(bool former) {
  record::StreamSpec spec;
  spec.name = "marks";
  spec.layout.add("tick", ColumnType::kCount, "", "");
  spec.layout.add("t", ColumnType::kReal, "s", "");
  spec.layout.add(former ? "other" : "model", ColumnType::kInt, "", "");
  spec.layout.add("left", ColumnType::kWord, "", "");
  spec.layout.add("text", ColumnType::kText, "", "");
  return spec;
}

record::StreamSpec ordersSpec() {
  record::StreamSpec spec;
  spec.name = "orders";
  spec.layout.add("tick", ColumnType::kCount, "", "");
  spec.layout.add("kind", ColumnType::kWord, "", "");
  spec.layout.add("target", ColumnType::kWord, "", "");
  return spec;
}

struct OrderStart {
  uint64_t tick;
  uint32_t kind, target;
};

MarkRow markOf(uint64_t tick, int32_t model, uint32_t left, const std::string& text) {
  MarkRow row;
  row.tick = tick, row.model = model, row.left = left;
  text.copy(row.text, kText);
  return row;
}

scene::Model modelNamed(const std::string& name) {
  scene::Model model;
  model.name = name;
  model.plugin = "nurbs_rigid";
  return model;
}

std::string jsonOf(const std::string& name) {
  return record::modelToJson(modelNamed(name));
}

/// The rows of a description, as the daemon writes them.
std::vector<MarkRow> described(uint64_t tick, int32_t number, const std::string& json) {
  std::vector<MarkRow> rows;
  const auto count = static_cast<uint32_t>((json.size() + kText - 1) / kText);
  for (uint32_t i = 0; i < count; ++i)
    rows.push_back(markOf(tick, number, count - 1 - i, json.substr(i * kText, kText)));
  return rows;
}

class RunModelsTest : public testing::Test {
 protected:
  /// A run of the models "first" and "second".
  RunModels of(const std::vector<MarkRow>& marks, const std::vector<OrderStart>& orders, bool former = false) {
    const std::vector<record::StreamSpec> streams = {marksSpec(former), ordersSpec()};
    file_ = testing::TempDir() + "models" + std::to_string(getpid());
    auto file =
        record::RecordingFile::create(file_, streams, {"{\"columns\": " + record::columnsJson(streams) + "}", ""});
    EXPECT_TRUE((*file)->append(0, reinterpret_cast<const std::byte*>(marks.data()), marks.size()));
    EXPECT_TRUE((*file)->append(1, reinterpret_cast<const std::byte*>(orders.data()), orders.size()));
    EXPECT_TRUE((*file)->close());
    recording_ = std::move(*record::Recording::open(file_));
    scene::Scene scene;
    scene.models = {modelNamed("first"), modelNamed("second")};
    return RunModels(*recording_, scene);
  }
  ~RunModelsTest() override { std::remove(file_.c_str()); }

  std::string file_;
  std::unique_ptr<record::Recording> recording_;
};

constexpr auto kCame = static_cast<uint32_t>(Order::Kind::kAdopt), kLeft = static_cast<uint32_t>(Order::Kind::kRelease);

TEST_F(RunModelsTest, ANumberMeansTheModelOfItsTick) {
  std::vector<MarkRow> marks = described(100, 2, jsonOf("third \xc3\xa4"));
  marks.insert(marks.begin() + 1, markOf(100, -1, 0, "a mark of a program in between"));
  for (const MarkRow& row : described(200, 0, jsonOf("fourth"))) marks.push_back(row);
  const RunModels models = of(marks, {{101, kCame, 2}, {201, kCame, 0}, {300, 1, 0}});
  ASSERT_EQ(models.all().size(), 4u);
  EXPECT_EQ(models.nameOf(0, 0), "first");
  EXPECT_EQ(models.nameOf(0, 199), "first");
  EXPECT_EQ(models.nameOf(0, 201), "fourth");
  EXPECT_EQ(models.nameOf(1, 1e9), "second");
  EXPECT_EQ(models.nameOf(2, 101), "third \xc3\xa4");
  EXPECT_EQ(models.all()[2].model.plugin, "nurbs_rigid");
  EXPECT_EQ(models.find(2, 99), RunModels::kNone);
  EXPECT_EQ(models.nameOf(2, 99), "model 2");
}

TEST_F(RunModelsTest, AModelIsThereUntilItLeavesOrItsNumberHasAnotherOne) {
  const RunModels models = of(described(100, 0, jsonOf("third")), {{90, kLeft, 1}, {101, kCame, 0}, {200, kLeft, 0}});
  ASSERT_EQ(models.all().size(), 3u);
  EXPECT_EQ(models.all()[0].until, 100u);  // the row of its leaving is lost
  EXPECT_EQ(models.all()[1].until, 90u);
  EXPECT_EQ(models.all()[2].until, 200u);
}

TEST_F(RunModelsTest, AModelWithoutADescriptionHasNotTheNameOfTheOneBefore) {
  const RunModels models = of(described(50, 0, jsonOf("new")), {{40, kCame, 0}, {51, kCame, 0}, {60, kCame, 0}}, false);
  EXPECT_EQ(models.nameOf(0, 39), "first");
  EXPECT_EQ(models.nameOf(0, 45), "model 0");
  EXPECT_EQ(models.nameOf(0, 51), "new");
  EXPECT_EQ(models.nameOf(0, 60), "model 0");
}

/// What a replay cannot build says why.
TEST_F(RunModelsTest, AModelThatCannotBeBuiltHasAReason) {
  hsp_class plugin{};
  plugin.id = plugin.version = "";
  const std::string whole = describeModel(modelNamed("whole"), modelNamed("whole"), plugin, 10'000);
  std::vector<MarkRow> marks = described(50, 0, whole);
  for (const MarkRow& row : described(60, 1, jsonOf("part"))) marks.push_back(row);
  marks.push_back(markOf(70, 2, 0, "{"));
  const std::vector<RunModel> later =
      of(marks, {{50, kCame, 0}, {61, kCame, 1}, {71, kCame, 2}, {80, kCame, 3}}).later();
  ASSERT_EQ(later.size(), 4u);
  EXPECT_EQ(later[0].lack, "");
  EXPECT_EQ(later[0].files.size(), 1u);
  EXPECT_NE(later[1].lack.find("only in part"), std::string::npos) << later[1].lack;
  EXPECT_NE(later[2].lack.find("damaged"), std::string::npos) << later[2].lack;
  EXPECT_NE(later[3].lack.find("does not describe it"), std::string::npos) << later[3].lack;
}

TEST_F(RunModelsTest, RecordingsFromBeforeDescriptionsAreRead) {
  const RunModels models = of({markOf(10, -1, 0, "trial 1 begins")}, {{40, kCame, 0}}, true);
  EXPECT_EQ(models.nameOf(0, 39), "first");
  EXPECT_EQ(models.nameOf(0, 40), "model 0");
}

TEST_F(RunModelsTest, ADamagedDescriptionGivesNoName) {
  std::vector<MarkRow> cut = described(50, 0, jsonOf("new"));
  ASSERT_GT(cut.size(), 1u);
  cut.erase(cut.begin());
  cut.push_back(markOf(70, 1, 0, "{\"name\": 7}"));
  cut.push_back(markOf(80, 70'000, 0, jsonOf("far")));
  std::vector<MarkRow> endless(4000, markOf(90, 1, 1, std::string(kText, '[')));
  endless.push_back(markOf(90, 1, 0, ""));
  cut.insert(cut.end(), endless.begin(), endless.end());
  const RunModels models = of(cut, {{51, kCame, 0}});
  EXPECT_EQ(models.nameOf(0, 51), "model 0");
  EXPECT_EQ(models.nameOf(1, 75), "model 1");
  EXPECT_EQ(models.nameOf(1, 95), "model 1");
  EXPECT_EQ(models.nameOf(-1, 5), "a model");
  EXPECT_EQ(models.nameOf(NAN, 5), "a model");
  EXPECT_EQ(models.find(INFINITY, 5), RunModels::kNone);
}

}  // namespace
}  // namespace hapticd::servo
