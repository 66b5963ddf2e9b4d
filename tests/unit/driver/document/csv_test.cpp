// SPDX-License-Identifier: MIT
#include "document/csv.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

namespace hapticd::document {
namespace {

const CsvRules kPath{{"t,x,y,z", "t,x,y,z,qw,qx,qy,qz"}, true, true, 1e6};

std::string firstProblem(const std::string& text, const CsvRules& rules = kPath) {
  Problems problems;
  EXPECT_FALSE(parseCsv(text, "p.csv", rules, problems));
  return problems.empty() ? "" : problems.front().text();
}

TEST(Csv, ReadsCommentsBlanksAndLineEndingsAlike) {
  Problems problems;
  const auto table =
      parseCsv("# made by hand\n\n t , x,y ,z\r\n0,1,2,3\r\n# between\n1e-3 , -1.5,+2,.5\n", "p.csv", kPath, problems);
  ASSERT_TRUE(table) << (problems.empty() ? "" : problems.front().text());
  ASSERT_EQ(table->rows(), 2u);
  EXPECT_EQ(table->columns, 4u);
  EXPECT_EQ(table->lines, (std::vector<int>{4, 6}));
  EXPECT_EQ(table->row(1)[0], 1e-3);
  EXPECT_EQ(table->row(1)[2], 2);
  EXPECT_EQ(table->row(1)[3], 0.5);
}

TEST(Csv, ReadsWhatSpreadsheetsAndStatisticsWrite) {
  Problems problems;
  for (const char* text : {"\xef\xbb\xbft,x,y,z\n0,1,2,3\n", "\"t\",\"x\",\"y\",\"z\"\r\n0,1,2,3\r\n"}) {
    const auto table = parseCsv(text, "p.csv", kPath, problems);
    ASSERT_TRUE(table) << problems.front().text();
    EXPECT_EQ(table->row(0)[3], 3);
  }
  EXPECT_EQ(firstProblem(std::string("\xff\xfet\0,\0x\0", 8)),
            "p.csv:1:1: the file is in UTF-16, expected UTF-8: save it as CSV UTF-8");
  EXPECT_EQ(firstProblem("t,\x1b[2J\n0,1\n"),
            "p.csv:1:1: the header is \"t,?[2J\", expected t,x,y,z or t,x,y,z,qw,qx,qy,qz");
}

TEST(Csv, TakesAFileWithoutAHeaderByTheNumberOfColumns) {
  Problems problems;
  const auto table = parseCsv("0,1,2,3,1,0,0,0\n1,1,2,3,1,0,0,0\n", "p.csv", kPath, problems);
  ASSERT_TRUE(table);
  EXPECT_EQ(table->columns, 8u);
  EXPECT_EQ(table->rows(), 2u);
}

TEST(Csv, NamesLineColumnAndWhatWasExpected) {
  EXPECT_EQ(firstProblem("t,x,y\n0,1,2\n"),
            "p.csv:1:1: the header is \"t,x,y\", expected t,x,y,z or t,x,y,z,qw,qx,qy,qz");
  EXPECT_EQ(firstProblem("t,x,y,z\n0,1,two,3\n"), "p.csv:2:5: y: \"two\" is not valid, expected a finite number");
  EXPECT_EQ(firstProblem("t,x,y,z\n0,1,2\n"), "p.csv:2:1: 3 columns, expected 4");
  EXPECT_EQ(firstProblem("t,x,y,z\n1,0,0,0\n1,0,0,0\n"),
            "p.csv:3:1: t: 1 does not grow from row to row, expected more than the 1 of the row before");
  EXPECT_EQ(firstProblem("t,x,y,z\n0,nan,0,0\n"), "p.csv:2:3: x: \"nan\" is not valid, expected a finite number");
  EXPECT_EQ(firstProblem("# only a comment\n"),
            "p.csv:1:1: there are no rows, expected a header t,x,y,z or t,x,y,z,qw,qx,qy,qz and at least one row");
}

TEST(Csv, SaysHowToWriteWhatASpreadsheetWrites) {
  EXPECT_EQ(firstProblem("t,x,y,z\n0,\"1\",2,3\n"),
            "p.csv:2:3: x: \"\"1\"\" is not valid, expected a finite number; write 1, without quotes or a tag");
  EXPECT_EQ(firstProblem("t,x,y,z\n0;0,5;1;2\n"),
            "p.csv:2:1: 2 columns, expected 4; separate columns by commas, and write decimals with a point");
  EXPECT_EQ(firstProblem("t,x,y,z\n0,0,5,1,2\n"),
            "p.csv:2:1: 5 columns, expected 4; write decimals with a point: 0.5, not 0,5");
  EXPECT_EQ(firstProblem("t,x,y,z\n0 1 2 3\n"),
            "p.csv:2:1: 1 column, expected 4; separate columns by commas, and write decimals with a point");
  EXPECT_EQ(firstProblem("t;x;y;z\n"),
            "p.csv:1:1: the header is \"t;x;y;z\", expected t,x,y,z or t,x,y,z,qw,qx,qy,qz; separate columns by "
            "commas, and write decimals with a point");
}

TEST(Csv, JudgesTheRowsBelowAWrongHeader) {
  const auto second = [](const std::string& text) {
    Problems problems;
    EXPECT_FALSE(parseCsv(text, "p.csv", kPath, problems));
    return problems.size() < 2 ? "" : problems[1].text();
  };
  EXPECT_EQ(second("x,y,z,t\n0,0,0,1\n0,0,two,2\n"), "p.csv:3:5: z: \"two\" is not valid, expected a finite number");
  EXPECT_EQ(second("x,y,z,t\n3,0,0,1\n2,0,0,2\n1,0,0,1\n"),
            "p.csv:4:1: t: 1 does not grow from row to row, expected more than the 2 of the row before");
  EXPECT_EQ(second("Time [s],X [mm],Y [mm],Z [mm]\n0,a,0,0\n").substr(0, 12), "p.csv:2:3: x");
  EXPECT_EQ(second("t,x,y,z,comment\n0,0,b,0,1\n").substr(0, 12), "p.csv:2:5: y");
  EXPECT_EQ(second("t;x;y;z\n0;0,5;c;0\n").substr(0, 12), "p.csv:2:7: y");
  EXPECT_EQ(second("0;0,5;c;0\n").substr(0, 12), "p.csv:1:7: y");
  EXPECT_EQ(second("a,b,c,d\n0,0,d,0\n"), "") << "columns that nothing names";
}

TEST(Csv, LetsNumbersBeNotFiniteWhereTheRulesSaySo) {
  const CsvRules probe{{"t,x,y,z"}, false, true};
  Problems problems;
  const auto table = parseCsv("t,x,y,z\n0,nan,inf,-inf\n1,.nan,1e999,1e-999\n", "p.csv", probe, problems);
  ASSERT_TRUE(table);
  EXPECT_TRUE(std::isnan(table->row(0)[1]) && std::isinf(table->row(0)[2]) && std::isnan(table->row(1)[1]));
  EXPECT_EQ(table->row(1)[3], 0);
  EXPECT_NE(firstProblem("t,x,y,z\nnan,0,0,0\n", probe), "");
}

TEST(Csv, StopsTellingAfterTwentyProblems) {
  std::string text = "t,x,y,z\n";
  for (int i = 0; i < 1000; ++i) text += "no,numbers,in,here\n";
  Problems problems;
  EXPECT_FALSE(parseCsv(text, "p.csv", kPath, problems));
  EXPECT_EQ(problems.size(), 20u);
}

TEST(Csv, KeepsTheSoundRowsOfAFileWithMistakesForJudging) {
  const std::string file = testing::TempDir() + "sound_rows.csv";
  std::ofstream(file) << "t,x\n0,1\n2,50\n1,3\n4,5,6\n5,x\n6,7\n";
  const auto rows = readSoundRows(file, 1000, {{"t,x"}, true, true});
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->values, (std::vector<double>{0, 1, 2, 50, 6, 7}));
  EXPECT_EQ(rows->lines, (std::vector<int>{2, 3, 7}));
  EXPECT_FALSE(readSoundRows(file, 1000, {{"a,b,c"}, true, true}));
}

TEST(Csv, NeverReturnsATableOfTheWrongSize) {
  std::mt19937 random(3);
  const std::string parts[] = {"0", "1", ",", "\n", "t,x,y,z\n", "#", " ", "nan", "1e9", "-", "\r\n", "q", "\0x"};
  for (int round = 0; round < 20000; ++round) {
    std::string text = round % 2 != 0 ? "t,x,y,z\n" : "";
    for (unsigned n = random() % 40; n > 0; --n) text += parts[random() % std::size(parts)];
    Problems problems;
    const auto table = parseCsv(text, "p.csv", kPath, problems);
    ASSERT_EQ(table.has_value(), problems.empty()) << text;
    if (table) {
      ASSERT_EQ(table->values.size(), table->rows() * table->columns) << text;
    }
  }
}

}  // namespace
}  // namespace hapticd::document
