// SPDX-License-Identifier: MIT
#include "record/report.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "record/pace_report.hpp"
#include "record/picture.hpp"

namespace hapticd::record {
namespace {

namespace fs = std::filesystem;

class Report : public testing::Test {
 protected:
  Report() { fs::create_directories(dir_); }
  ~Report() override { fs::remove_all(dir_); }
  std::string file(const std::string& name) const { return (dir_ / name).string(); }
  static std::string read(const std::string& name) {
    std::ifstream in(name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static RunReport sample() {
    RunReport report;
    report.scene = "a <scene> & more";
    report.ticks = 1000;
    report.rate_hz = 1000;
    report.seconds = 1;
    report.lateness_us.add(3);
    report.models.push_back({"ball", "sphere", {}});
    report.models[0].contact.add(true, 0.002, 1.5, 1e-3, 400);
    for (int i = 0; i < 6; ++i) report.models[0].contact.addFoot(i < 2, i < 1);
    report.faults = {"the arm is gone"};
    return report;
  }

 private:
  fs::path dir_ = fs::temp_directory_path() / ("hapticd-report-" + std::to_string(getpid()));
};

testing::AssertionResult tells(const std::string& text, const std::string& words) {
  const bool does = text.find(words) != std::string::npos;
  return (does ? testing::AssertionSuccess() : testing::AssertionFailure()) << words << "\nin\n" << text;
}

ClientReport client(const std::string& program, uint64_t answers, uint64_t in_time) {
  ClientReport one;
  one.device = "arm", one.program = program, one.pid = 7;
  one.answers = answers, one.in_time = in_time, one.next_tick = answers - in_time;
  one.silences = 1, one.largest_n = 2.5;
  return one;
}

TEST_F(Report, TellsOfContactWithoutForce) {
  RunReport report = sample();
  report.models[0].contact = {};
  for (int i = 0; i < 300; ++i) report.models[0].contact.addUnfelt();
  const std::string text = summary(report);
  EXPECT_TRUE(tells(text, "no force  in 300 further ticks: the model was disabled, or waited"));
  EXPECT_FALSE(tells(text, "touched no model"));
}

TEST_F(Report, TellsOfProgramsThatPushed) {
  RunReport report = sample();
  add(report.clients, client("spring", 1000, 990));
  add(report.clients, client("late", 1000, 200));
  add(report.clients, client("spring", 1000, 970));
  ASSERT_TRUE(writeJson(report, file("r.json")));
  const auto clients = nlohmann::json::parse(read(file("r.json"))).at("clients");
  ASSERT_EQ(clients.size(), 2u);
  EXPECT_EQ(clients[0].at("program"), "spring");
  EXPECT_EQ(clients[0].at("times"), 2);
  EXPECT_EQ(clients[0].at("answers"), 2000);
  EXPECT_DOUBLE_EQ(clients[0].at("same_tick"), 0.98);
  EXPECT_DOUBLE_EQ(clients[0].at("next_tick"), 0.02);
  EXPECT_EQ(clients[0].at("silences"), 2);
  EXPECT_DOUBLE_EQ(clients[0].at("largest_n"), 2.5);
  const std::string text = summary(report);
  EXPECT_TRUE(tells(text,
                    "program spring on arm: 2000 answers, 98.0 % in the same tick, 2.0 % in the next; silent 2 times; "
                    "force max 2.50 N\nprogram late"));
  EXPECT_TRUE(tells(text, "answer_time: 60e-6")) << "the late one is told what helps";
  report.answer_time = 60e-6;
  EXPECT_FALSE(tells(summary(report), "answer_time")) << "that is set already";
  for (int i = 0; i < 100; ++i) add(report.clients, client("p" + std::to_string(i), 1, 1));
  EXPECT_EQ(report.clients.size(), 32u);
  EXPECT_EQ(report.clients.back().program, "p99");
}

TEST_F(Report, HasEveryPromisedKeyInItsUnit) {
  ASSERT_TRUE(writeJson(sample(), file("r.json")));
  const auto json = nlohmann::json::parse(read(file("r.json")));
  for (const char* key : {"ticks", "rate_hz", "overruns", "missed_ticks", "page_faults", "servo_allocations"})
    EXPECT_TRUE(json.at(key).is_number()) << key;
  for (const char* key : {"lateness_us", "compute_us"})
    for (const char* quantile : {"p50", "p99", "p999", "max"}) EXPECT_TRUE(json.at(key).at(quantile).is_number());
  const auto& ball = json.at("models").at("ball");
  EXPECT_EQ(ball.at("plugin"), "sphere");
  EXPECT_EQ(ball.at("contact_ticks"), 1);
  EXPECT_EQ(ball.at("feet"), nlohmann::json({{"nearest", 4}, {"held", 1}, {"degraded", 1}}));
  EXPECT_DOUBLE_EQ(ball.at("penetration_mm").at("max"), 2);
  EXPECT_DOUBLE_EQ(ball.at("penetration_mm").at("std"), 0);
  EXPECT_DOUBLE_EQ(ball.at("force_n").at("mean"), 1.5);
  EXPECT_DOUBLE_EQ(ball.at("buzz_mm"), 0);
  EXPECT_DOUBLE_EQ(ball.at("step_ns").at("max"), 400);
  EXPECT_EQ(json.at("faults"), nlohmann::json::array({"the arm is gone"}));
}

TEST_F(Report, IsWrittenWholeOrNotAtAll) {
  const auto written = writeJson(sample(), file("no-such-folder/r.json"));
  ASSERT_FALSE(written);
  EXPECT_TRUE(tells(written.error(), "no-such-folder"));
  ASSERT_TRUE(writeJson(sample(), file("r.json")));
  EXPECT_FALSE(fs::exists(file("r.json.part")));
}

TEST_F(Report, TellsPeopleFaultsAndContact) {
  const std::string text = summary(sample());
  for (const char* words : {"1000 ticks", "ball (sphere)", "max 2.000 mm", "fault: the arm is gone"})
    EXPECT_TRUE(tells(text, words));
}

TEST_F(Report, HasARowForEachOfTwoArms) {
  RunReport report = sample();
  report.models[0].arms = {{"left", {}}, {"right", report.models[0].contact}};
  ASSERT_TRUE(writeJson(report, file("r.json")));
  const auto ball = nlohmann::json::parse(read(file("r.json"))).at("models").at("ball");
  EXPECT_EQ(ball.at("arms").at("left").at("contact_ticks"), 0);
  EXPECT_DOUBLE_EQ(ball.at("arms").at("right").at("penetration_mm").at("max"), 2);
  EXPECT_EQ(ball.at("contact_ticks"), 1);
  EXPECT_EQ(ball.at("feet"), nlohmann::json({{"nearest", 4}, {"held", 1}, {"degraded", 1}}));
  const std::string text = summary(report);
  EXPECT_TRUE(tells(text, "(0 ticks) by left"));
  EXPECT_TRUE(tells(text, "(1 ticks) by right"));
}

TEST_F(Report, TellsPeopleOfModelsThatAnsweredCoarserWithoutContact) {
  RunReport report = sample();
  EXPECT_FALSE(tells(summary(report), "accuracy"));
  report.models.push_back({"far", "sphere", {}});
  report.models[1].degraded_ticks = 500;
  EXPECT_TRUE(tells(summary(report), "lowered for 1 of 2 models, in up to 50 % of the ticks"));
}

TEST_F(Report, NamesAModelWhoseStepsTakeLongerThanThePeriod) {
  RunReport report = sample();
  for (int i = 0; i < 1000; ++i) {
    report.compute_us.add(i < 220 ? 5150 : 12);
    report.models[0].contact.add(true, 0.002, 1.5, 1e-3, i < 220 ? 5'100'000 : 400);
  }
  EXPECT_EQ(paceText(report, 1000),
            "slow: ball took 5.1 ms in 220 ticks; the period is 1 ms: find the cause with hapticd plugin check\n");
  report.virtual_time = true;
  const std::string text = paceText(report, 1000);
  EXPECT_TRUE(
      tells(text, "220 of 1000 ticks took longer than their period of 1 ms: at this cost 1000 Hz would not be held"));
  EXPECT_EQ(paceText(report, 100), "") << "a period of 10 ms is enough";
}

TEST_F(Report, NamesAModelThatSleepsByItsLongestStep) {
  RunReport report = sample();
  for (int i = 0; i < 1000; ++i) report.compute_us.add(i < 200 ? 5060 : 12);
  report.models[0].contact.add(true, 0.002, 1.5, 1e-3, 5'030'000);
  const std::string text = paceText(report, 1000);
  EXPECT_TRUE(tells(text, "200 of 1000 ticks took longer than the period of 1 ms, and ball up to 5 ms"));
}

TEST_F(Report, SaysNothingOfAFewTicksThatABusyMachineWasLateIn) {
  RunReport report = sample();
  report.virtual_time = true;
  for (int i = 0; i < 1000; ++i) {
    report.compute_us.add(i < 9 ? 8000 : 12);
    report.models[0].contact.add(true, 0.002, 1.5, 1e-3, i < 9 ? 7'000'000 : 400);
  }
  EXPECT_EQ(paceText(report, 1000), "");
}

// Of a thousand ticks 30 were interrupted, as on a machine that builds something meanwhile.
TEST_F(Report, BlamesNoModelForABusyMachineInVirtualTime) {
  RunReport report = sample();
  for (int i = 0; i < 1000; ++i) {
    report.compute_us.add(i < 30 ? 8000 : 12);
    report.models[0].contact.add(true, 0.002, 1.5, 1e-3, i < 30 ? 7'000'000 : 400);
  }
  report.virtual_time = true;
  EXPECT_EQ(paceText(report, 1000), "");
}

TEST_F(Report, TellsPeopleThatNothingWasTouched) {
  RunReport report = sample();
  EXPECT_FALSE(tells(summary(report), "touched no model"));
  report.models[0].contact = {};
  EXPECT_TRUE(tells(summary(report), "touched no model"));
  report.faults = {"model ball: its plugin pulled the probe into its surface"};
  EXPECT_FALSE(tells(summary(report), "touched no model")) << "that it was silenced says why";
}

TEST_F(Report, TellsPeopleOfForceWithoutASurface) {
  RunReport report = sample();
  EXPECT_FALSE(tells(summary(report), "HSP_OUT_TRACED"));
  report.models[0].contact = {};
  report.models[0].contact.addUntraced(0.5);
  report.models[0].contact.addUntraced(1.12);
  const std::string text = summary(report);
  EXPECT_TRUE(tells(text, "warning   ball pushed in 2 ticks without HSP_OUT_TRACED, with up to 1.12 N"));
  EXPECT_FALSE(tells(text, "touched no model"));
  ASSERT_TRUE(writeJson(report, file("r.json")));
  const auto ball = nlohmann::json::parse(read(file("r.json"))).at("models").at("ball");
  EXPECT_EQ(ball.at("untraced").at("ticks"), 2);
  EXPECT_DOUBLE_EQ(ball.at("untraced").at("force_max_n"), 1.12);
}

TEST_F(Report, TellsPeopleOfForceWithoutADepthAndFromOutside) {
  RunReport report = sample();
  report.models[0].contact = {};
  report.models[0].contact.addDepthless(0.5);
  report.models[0].contact.addDepthless(1.12);
  report.models[0].contact.addOutside(0.25);
  const std::string text = summary(report);
  EXPECT_TRUE(tells(text, "warning   ball pushed in 2 ticks with depth_m left at 0, with up to 1.12 N"));
  EXPECT_TRUE(tells(text, "outside   ball pushed in 1 ticks from outside (depth_m below 0), with up to 0.25 N"));
  EXPECT_FALSE(tells(text, "HSP_OUT_TRACED"));
  EXPECT_FALSE(tells(text, "touched no model"));
  ASSERT_TRUE(writeJson(report, file("r.json")));
  const auto ball = nlohmann::json::parse(read(file("r.json"))).at("models").at("ball");
  EXPECT_EQ(ball.at("depthless").at("ticks"), 2);
  EXPECT_DOUBLE_EQ(ball.at("outside").at("force_max_n"), 0.25);

  // Beside contacts, what lasts longer than they do is told, and no more.
  report.models[0].contact = sample().models[0].contact;
  report.models[0].contact.addOutside(0.25);
  EXPECT_FALSE(tells(summary(report), "outside"));
  for (uint64_t i = 0; i < report.models[0].contact.contactTicks(); ++i) report.models[0].contact.addOutside(1);
  EXPECT_TRUE(tells(summary(report), "outside   ball pushed in "));
}

TEST_F(Report, TellsPeopleOfAPullThatLastsMostOfAContact) {
  RunReport report = sample();
  report.models[0].contact = {};
  for (int i = 0; i < 10; ++i) report.models[0].contact.add(true, 0.001, 1.5, 1e-3, 0);
  for (int i = 0; i < 5; ++i) report.models[0].contact.addPull(0.5);  // as a detent does
  EXPECT_FALSE(tells(summary(report), "pulled"));
  report.models[0].contact.addPull(1.5);
  EXPECT_TRUE(tells(summary(report),
                    "warning   ball pulled the hand in during 60 % of its contact, with up to 1.50 N: its "
                    "force may have the wrong sign; test it with hapticd plugin check"));
  ASSERT_TRUE(writeJson(report, file("r.json")));
  EXPECT_EQ(nlohmann::json::parse(read(file("r.json"))).at("models").at("ball").at("pulls").at("ticks"), 6);
}

TEST_F(Report, TellsPeopleOfAModelThatDrivesTheHand) {
  RunReport report = sample();
  report.models[0].given_j = 0.01125, report.models[0].taken_j = 0.00625;
  EXPECT_TRUE(tells(summary(report), "warning   ball gave the hand 5 mJ more than it took (6.25 mJ)"));
  report.models[0].library = "my-plugins/ball.so";
  EXPECT_TRUE(tells(summary(report), "find the cause with hapticd plugin check my-plugins/ball.so\n"));
  report.models[0].moves = true;  // it may have had that
  EXPECT_FALSE(tells(summary(report), "gave the hand"));
  report.models[0].moves = false, report.models[0].began_j = 0.0051;
  EXPECT_FALSE(tells(summary(report), "gave the hand")) << "the hand began inside";
  report.models[0].began_j = 0, report.models[0].given_j = 0.0063, report.models[0].taken_j = 0.00625;
  EXPECT_FALSE(tells(summary(report), "gave the hand"));
}

TEST_F(Report, TellsAResidualInAUnitThatReadsWell) {
  RunReport report = sample();
  report.models[0].degraded_ticks = 3;
  report.models[0].residual_m = 7.39e-3;
  EXPECT_TRUE(tells(summary(report), "error up to 7.39 mm"));
  report.models[0].residual_m = 12e-6;
  EXPECT_TRUE(tells(summary(report), "error up to 12 um"));
}

TEST_F(Report, DrawsEveryPeakAndEscapesNames) {
  std::vector<Sample> samples(5000);
  for (size_t i = 0; i < samples.size(); ++i) samples[i].t = static_cast<double>(i) * 1e-3;
  samples[2500].force_n = 7;
  for (size_t i = 3000; i < 3500; ++i) {
    samples[i].fault = i < 3250 ? 5 : 2;
    samples[i].depth_m = i % 7 == 0 ? std::nan("") : 1e-3;
    samples[i].model = 1;
  }
  ASSERT_TRUE(drawRun(sample(), samples, {.models = {"far", "<ball>"}, .force_limit_n = 8, .positions = true},
                      file("run.svg")));
  const std::string svg = read(file("run.svg"));
  for (const char* words :
       {"too fast", "device lost", "&lt;ball&gt;", "limits.force: 8 N", "% of the ticks", "lateness"})
    EXPECT_TRUE(tells(svg, words));
  EXPECT_FALSE(tells(svg, "&gt;far&lt;"));
  EXPECT_TRUE(tells(svg, "a &lt;scene&gt; &amp; more"));
  EXPECT_FALSE(tells(svg, "nan"));
  EXPECT_TRUE(tells(svg, "</svg>"));
  EXPECT_LT(svg.size(), 200000u);
}

TEST_F(Report, NamesTheModelWhoseOneStepMadeTicksMiss) {
  RunReport report = sample();
  report.models.push_back({"donut", "torus", {}});
  for (int i = 0; i < 1000; ++i) report.models[1].contact.add(false, 0, 0, 1e-3, 2000);
  EXPECT_EQ(paceText(report, 1000), "");
  report.models[1].contact.add(false, 0, 0, 1e-3, 20'000'000);
  EXPECT_EQ(paceText(report, 1000), "") << "no tick was missed";
  report.missed_ticks = 19;
  EXPECT_TRUE(tells(paceText(report, 1000), "slow: 19 ticks were missed, and donut took 20 ms in its longest step"));
  report.virtual_time = true;
  EXPECT_EQ(paceText(report, 1000), "") << "the wall clock of a busy machine makes as much";
  report.models[1].contact.add(false, 0, 0, 1e-3, 2'000'000'000);
  EXPECT_TRUE(tells(paceText(report, 1000), "slow: donut took 2e+03 ms in its longest step"));
}

TEST_F(Report, DoubtsADepthThatNoArmReaches) {
  RunReport report = sample();
  EXPECT_FALSE(tells(summary(report), "must be in m"));
  report.models[0].contact.add(true, 2.7, 1.5, 1e-3, 0);
  EXPECT_TRUE(tells(summary(report),
                    "ball reports a depth of 2.7 m, deeper than an arm reaches: depth_m must be in m (if it "
                    "is in mm, the depth was 0.0027 m)"));
}

TEST_F(Report, MarksWhatHappenedAndWhoseItIs) {
  std::vector<Sample> samples(1000);
  for (size_t i = 0; i < samples.size(); ++i) {
    samples[i].t = static_cast<double>(i) * 1e-3;
    samples[i].depth_m = i < 500 ? -0.03 : 1e-3;
    samples[i].model = 0;
  }
  RunNotes notes{.models = {"ring"}};
  notes.moments = {{0.7, "ring is silenced"}, {9, "beyond the picture"}};
  notes.arm = "left";
  ASSERT_TRUE(drawRun(sample(), samples, notes, file("run.svg")));
  std::string svg = read(file("run.svg"));
  for (const char* words : {"ring is silenced", ", left<", "mm drawn at the bottom edge"})
    EXPECT_TRUE(tells(svg, words));
  EXPECT_FALSE(tells(svg, "beyond the picture"));
  for (Sample& sample : samples) sample.depth_m = -0.036;
  ASSERT_TRUE(drawRun(sample(), samples, {}, file("run.svg")));
  EXPECT_TRUE(tells(read(file("run.svg")), "(no contact: distance from the nearest model)"));
  for (Sample& sample : samples) sample.depth_m = std::nan(""), sample.model = -1;
  ASSERT_TRUE(drawRun(sample(), samples, {}, file("run.svg")));
  svg = read(file("run.svg"));
  EXPECT_TRUE(tells(svg, "no model was near enough to be traced"));
  EXPECT_FALSE(tells(svg, "1e-0")) << "an axis of nothing but zeros";
  for (size_t i = 0; i < 600; ++i) samples[i].force_n = 2;
  ASSERT_TRUE(drawRun(sample(), samples, {}, file("run.svg")));
  EXPECT_TRUE(tells(read(file("run.svg")), "distribution of 600 ticks")) << "the forces of programs without a model";
}

TEST_F(Report, SaysWhenThereIsNothingToDraw) {
  EXPECT_FALSE(drawRun(sample(), {}, {}, file("run.svg")));
}

}  // namespace
}  // namespace hapticd::record
