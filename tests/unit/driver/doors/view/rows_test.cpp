// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include "playback.hpp"
#include "record/flight_ring.hpp"
#include "row_source.hpp"

namespace hapticd::view {
namespace {

namespace fs = std::filesystem;

/// A row whose words all follow from its number: one that is torn shows.
struct Row {
  uint64_t tick = 0, twice = 0;
  double t = 0;
};

class Rows : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("view_rows_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    streams_.resize(2);
    streams_[0].name = "ticks";
    streams_[0].ring_rows = 101;
    streams_[0].layout.add("tick", record::ColumnType::kCount, "", "");
    streams_[0].layout.add("twice", record::ColumnType::kCount, "", "");
    streams_[0].layout.add("t", record::ColumnType::kReal, "s", "");
    streams_[1].name = "contacts";
    streams_[1].ring_rows = 50;
    streams_[1].layout.add("tick", record::ColumnType::kCount, "", "");
    about_.json = R"({"columns":)" + record::columnsJson(streams_) + "}";
    auto ring = record::FlightRing::create(streams_, about_, file());
    ASSERT_TRUE(ring) << ring.error();
    ring_ = std::move(*ring);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file() const { return (folder_ / "black.h5").string(); }
  void write(uint64_t tick) {
    const Row row{tick, 2 * tick, static_cast<double>(tick) * 1e-3};
    std::memcpy(ring_->next(0), &row, sizeof row);
    ring_->commit(0);
  }
  void touch(uint64_t tick) {
    std::memcpy(ring_->next(1), &tick, sizeof tick);
    ring_->commit(1);
  }

  fs::path folder_;
  std::vector<record::StreamSpec> streams_;
  record::About about_;
  std::unique_ptr<record::FlightRing> ring_;
};

TEST_F(Rows, OfABlackBoxComeAsTheyAreWritten) {
  auto source = openBlackBox(file());
  ASSERT_TRUE(source) << source.error();
  const RowSource& rows = **source;
  EXPECT_EQ(rows.aboutJson(), about_.json);
  EXPECT_EQ(rows.find("contacts"), 1u);
  EXPECT_EQ(rows.find("nothing"), 2u);
  EXPECT_EQ(rows.end(0), 0u);
  for (uint64_t i = 0; i < 250; ++i) write(i);
  EXPECT_EQ(rows.end(0), 250u);
  EXPECT_EQ(rows.begin(0), 150u);
  std::vector<Row> got(100);
  EXPECT_EQ(rows.copy(0, 149, 1, reinterpret_cast<std::byte*>(got.data())), 0u) << "overwritten";
  EXPECT_EQ(rows.copy(0, 250, 1, reinterpret_cast<std::byte*>(got.data())), 0u) << "not yet written";
  ASSERT_EQ(rows.copy(0, 150, 1000, reinterpret_cast<std::byte*>(got.data())), 100u);
  for (uint64_t i = 0; i < 100; ++i) EXPECT_EQ(got[i].tick, 150 + i);
}

TEST_F(Rows, AreNeverTornWhileTheServoWrites) {
  auto source = openBlackBox(file());
  ASSERT_TRUE(source);
  std::atomic<bool> ended{false};
  std::thread servo([&] {
    for (uint64_t i = 0; i < 300'000; ++i) write(i);
    ended = true;
  });
  std::vector<Row> got(64);
  uint64_t copied = 0;
  for (bool last = false; !last;) {
    last = ended;  // once more after its end: then there are rows for sure
    const uint64_t end = (*source)->end(0), first = end > 40 ? end - 40 : 0;
    const uint64_t count = (*source)->copy(0, first, 20, reinterpret_cast<std::byte*>(got.data()));
    for (uint64_t i = 0; i < count; ++i) {
      EXPECT_EQ(got[i].tick, first + i);
      EXPECT_EQ(got[i].twice, 2 * got[i].tick);
    }
    copied += count;
  }
  servo.join();
  EXPECT_GT(copied, 0u);
}

TEST_F(Rows, OfATickAreFoundByBisection) {
  auto source = openBlackBox(file());
  ASSERT_TRUE(source);
  for (uint64_t i = 0; i < 90; ++i) write(i);
  for (const uint64_t tick : {3, 3, 7, 40, 40, 40}) touch(tick);
  EXPECT_EQ(firstRowOf(**source, 0, 50), 50u);
  EXPECT_EQ(firstRowOf(**source, 1, 0), 0u);
  EXPECT_EQ(firstRowOf(**source, 1, 4), 2u);
  EXPECT_EQ(firstRowOf(**source, 1, 40), 3u);
  EXPECT_EQ(firstRowOf(**source, 1, 41), 6u);
}

TEST_F(Rows, OfABrokenFileAreRefused) {
  EXPECT_FALSE(openBlackBox((folder_ / "none").string()));
  std::ofstream(folder_ / "text") << "no black box";
  EXPECT_FALSE(openBlackBox((folder_ / "text").string()));
  std::string bytes(2000, '\0');
  std::ifstream(file(), std::ios::binary).read(bytes.data(), 2000);
  std::ofstream(folder_ / "short", std::ios::binary) << bytes;
  EXPECT_FALSE(openBlackBox((folder_ / "short").string()));
}

TEST_F(Rows, OfARecordingArePlayedFromWhereSomebodyWants) {
  for (uint64_t i = 0; i < 90; ++i) write(i);
  for (const uint64_t tick : {10, 20, 80}) touch(tick);
  const std::string dump = (folder_ / "dump.h5").string();
  ASSERT_TRUE(ring_->dump(dump));
  auto source = openRecording(dump);
  ASSERT_TRUE(source) << source.error();
  Playback playback(**source, Json::parse((*source)->aboutJson()));
  EXPECT_EQ(playback.execute({{"do", "pause"}}), "");
  EXPECT_EQ(playback.execute({{"do", "seek"}, {"t", 0.050}}), "");
  EXPECT_TRUE(playback.takeJumped());
  EXPECT_FALSE(playback.takeJumped());
  EXPECT_EQ(playback.ends()[0], 51u) << "ticks 0 to 50";
  EXPECT_EQ(playback.ends()[1], 2u);
  EXPECT_EQ(playback.rowsFrom(0.0305)[0], 20u);
  EXPECT_EQ(playback.rowsFrom(0.0305)[1], 1u);
  playback.advance();
  EXPECT_EQ(playback.ends()[0], 51u) << "it stands";
}

TEST_F(Rows, OfARecordingAreNotPlayedOutsideOfIt) {
  for (uint64_t i = 0; i < 90; ++i) write(i);
  const std::string dump = (folder_ / "dump.h5").string();
  ASSERT_TRUE(ring_->dump(dump));
  auto source = openRecording(dump);
  ASSERT_TRUE(source);
  Playback playback(**source, Json::parse((*source)->aboutJson()));
  for (const Json& bad : {Json{{"do", "seek"}}, Json{{"do", "seek"}, {"t", -1}}, Json{{"do", "seek"}, {"t", 1e300}},
                          Json{{"do", "seek"}, {"t", "1"}}, Json{{"do", "play"}, {"speed", 0}},
                          Json{{"do", "play"}, {"speed", -1}}, Json{{"do", "play"}, {"speed", 1e9}}})
    EXPECT_NE(playback.execute(bad), "") << bad.dump();
  EXPECT_TRUE(Playback::knows("seek"));
  EXPECT_FALSE(Playback::knows("stop"));
}

TEST_F(Rows, OfAnEmptyRecordingDoNoHarm) {
  const std::string dump = (folder_ / "dump.h5").string();
  ASSERT_TRUE(ring_->dump(dump));
  auto source = openRecording(dump);
  ASSERT_TRUE(source);
  Playback playback(**source, Json::parse((*source)->aboutJson()));
  playback.advance();
  EXPECT_EQ(playback.ends()[0], 0u);
  EXPECT_EQ(playback.rowsFrom(10)[0], 0u);
}

}  // namespace
}  // namespace hapticd::view
