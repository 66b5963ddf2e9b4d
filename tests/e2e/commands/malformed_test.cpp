// SPDX-License-Identifier: MIT
/// Every file of tests/scenes/malformed is refused with exit code 2 and a problem that says where; a first line
/// `# expect: TEXT` names what the message must hold. A new case is a new file.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <vector>

#include "run_program.hpp"

namespace hapticd::test {
namespace {

std::vector<std::filesystem::path> corpus() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(HAPTICD_SOURCE_DIR "/tests/scenes/malformed"))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string expectation(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  constexpr const char* kMark = "# expect: ";
  return line.rfind(kMark, 0) == 0 ? line.substr(std::string(kMark).size()) : "";
}

TEST(Malformed, CorpusIsThere) {
  EXPECT_GE(corpus().size(), 100u);
}

class MalformedFile : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(MalformedFile, IsRefusedWithPlaceAndReason) {
  const Outcome outcome = run("check " + GetParam().string());
  EXPECT_EQ(outcome.signal, 0) << outcome.text;
  EXPECT_EQ(outcome.exit_code, 2) << outcome.text;
  const std::regex place("(^|\\n)[^\\n]*\\.(yaml|csv):[1-9][0-9]*:[1-9][0-9]*: [^\\n]+");
  EXPECT_TRUE(std::regex_search(outcome.text, place)) << outcome.text;
  EXPECT_TRUE(has(outcome.text, expectation(GetParam()))) << outcome.text << "\nexpected: " << expectation(GetParam());
}

std::string nameOf(const testing::TestParamInfo<std::filesystem::path>& info) {
  std::string name = info.param.stem().string();
  std::replace_if(name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Corpus, MalformedFile, testing::ValuesIn(corpus()), nameOf);

}  // namespace
}  // namespace hapticd::test
