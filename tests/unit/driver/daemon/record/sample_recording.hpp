// SPDX-License-Identifier: MIT
/// A recording of two streams, ticks and events, whose rows follow from the number of the tick.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "record/recording.hpp"
#include "record/recording_file.hpp"

namespace hapticd::record {

struct Row {
  uint64_t tick;
  double x;
  float y;
  int32_t status;
};

inline std::vector<StreamSpec> specs(uint64_t ring_rows = 100) {
  StreamSpec ticks, events;
  ticks.name = "ticks";
  ticks.layout.add("tick", ColumnType::kCount, "", "number");
  ticks.layout.add("x", ColumnType::kReal, "m", "a place");
  ticks.layout.add("y", ColumnType::kReal32, "us", "a time");
  ticks.layout.add("status", ColumnType::kInt, "", "an answer");
  ticks.ring_rows = ring_rows;
  events.name = "events";
  events.layout.add("tick", ColumnType::kCount, "", "number");
  events.layout.add("kind", ColumnType::kWord, "", "what");
  events.ring_rows = ring_rows;
  return {ticks, events};
}

inline About about() {
  return {"{\"columns\": " + columnsJson(specs()) + "}", "hapticd: 1\n# \xc3\xa9\n"};
}

inline Row rowOf(uint64_t tick) {
  const auto t = static_cast<double>(tick);
  return {tick, 0.5 * t, static_cast<float>(0.25 * t), -static_cast<int32_t>(tick % 7)};
}

inline std::string temporary(const char* name) {
  return testing::TempDir() + name + std::to_string(getpid());
}

inline void expectRows(const RecordedStream& stream, uint64_t first, uint64_t count) {
  ASSERT_EQ(stream.rows(), count);
  ASSERT_EQ(stream.columns().size(), 4u);
  for (uint64_t i = 0; i < count; ++i) {
    const Row wanted = rowOf(first + i);
    ASSERT_EQ(stream.number(i, *stream.find("tick")), static_cast<double>(wanted.tick)) << "row " << i;
    ASSERT_EQ(stream.number(i, *stream.find("x")), wanted.x);
    ASSERT_EQ(stream.number(i, *stream.find("y")), wanted.y);
    ASSERT_EQ(stream.number(i, *stream.find("status")), wanted.status);
  }
}

/// Writes `count` rows in pieces of `piece`, the events every tenth tick.
inline void write(RecordingFile& file, uint64_t from, uint64_t count, uint64_t piece) {
  std::vector<Row> rows;
  for (uint64_t tick = from; tick < from + count; ++tick) {
    rows.push_back(rowOf(tick));
    if (rows.size() < piece && tick + 1 < from + count) continue;
    ASSERT_TRUE(file.append(0, reinterpret_cast<const std::byte*>(rows.data()), rows.size()));
    const uint64_t event[2] = {tick, 3};
    ASSERT_TRUE(file.append(1, reinterpret_cast<const std::byte*>(event), 1));
    rows.clear();
  }
}

}  // namespace hapticd::record
