// SPDX-License-Identifier: MIT
#include "record/recorded_stream.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "sample_recording.hpp"

namespace hapticd::record {
namespace {

TEST(RecordedStream, ARowStaysWhileThreeOtherPlacesAreRead) {
  const std::string name = temporary("pages");
  auto file = RecordingFile::create(name, specs(), about(), sizeof(Row));  // one row in a chunk, so one in a page
  ASSERT_TRUE(file);
  write(**file, 0, 20, 1);
  ASSERT_TRUE((*file)->close());
  const auto recording = Recording::open(name);
  ASSERT_TRUE(recording) << recording.error();
  const RecordedStream& ticks = *(*recording)->stream("ticks");
  for (uint64_t i = 0; i < 4; ++i) ticks.row(i);
  const std::byte* again = ticks.row(0);
  for (uint64_t i = 4; i < 7; ++i) ticks.row(i);
  uint64_t tick = 0;
  std::memcpy(&tick, again, sizeof tick);
  EXPECT_EQ(tick, 0u);
}

}  // namespace
}  // namespace hapticd::record
