// SPDX-License-Identifier: MIT
/// Columns of a recording that hold texts.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "output_of.hpp"
#include "record/recording.hpp"
#include "record/recording_file.hpp"

namespace hapticd::record {
namespace {

/// Returns what an HDF5 library that is not ours reads as the text of each row of `marks`.
std::string textsByPython(const std::string& file) {
  return outputOf("/usr/bin/python3 -c 'import h5py; print([t.decode() for t in h5py.File(\"" + file +
                  "\")[\"marks\"][\"text\"]])'");
}

TEST(RecordingFile, GivesBackTexts) {
  StreamSpec marks;
  marks.name = "marks";
  marks.layout.add("tick", ColumnType::kCount, "", "number");
  marks.layout.add("text", ColumnType::kText, "", "what was said");
  const std::vector<StreamSpec> streams = {marks};
  ASSERT_EQ(marks.layout.rowBytes(), 8 + kTextBytes);
  struct TextRow {
    uint64_t tick;
    char text[kTextBytes];
  };
  TextRow rows[] = {{7, "trial 7 begins, \xc3\xa4"}, {8, ""}, {9, ""}};
  std::fill_n(rows[2].text, kTextBytes - 1, 'x');
  const std::string name = testing::TempDir() + "texts" + std::to_string(getpid());
  auto file = RecordingFile::create(name, streams, {"{\"columns\": " + columnsJson(streams) + "}", "hapticd: 1\n"});
  ASSERT_TRUE(file);
  ASSERT_TRUE((*file)->append(0, reinterpret_cast<const std::byte*>(rows), std::size(rows)));
  ASSERT_TRUE((*file)->close());
  const auto recording = Recording::open(name);
  ASSERT_TRUE(recording) << recording.error();
  const RecordedStream& read = *(*recording)->stream("marks");
  const Column &text = *read.find("text"), &tick = *read.find("tick");
  for (uint64_t i = 0; i < std::size(rows); ++i) EXPECT_EQ(read.text(i, text), rows[i].text);
  EXPECT_TRUE(std::isnan(read.number(0, text))) << "a text is no number";
  EXPECT_EQ(read.text(0, tick), "") << "a number is no text";
  EXPECT_EQ(textsByPython(name), "['trial 7 begins, \xc3\xa4', '', '" + std::string(kTextBytes - 1, 'x') + "']\n");
  std::remove(name.c_str());
}

}  // namespace
}  // namespace hapticd::record
