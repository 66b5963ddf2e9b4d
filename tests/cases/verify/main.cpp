// SPDX-License-Identifier: MIT
/// verify_cases DIR: every truth case of a folder through the production kernels.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

#include "verify.hpp"

namespace hapticd::verify {
namespace {

namespace fs = std::filesystem;

struct Score {
  int passed = 0, total = 0;
  long double worst = 0;
};

/// The cases of one file, or nothing with a message.
std::optional<std::vector<Case>> readCases(const fs::path& file) {
  std::ifstream in(file);
  const Json list = Json::parse(in, nullptr, false);
  if (list.is_discarded() || !list.is_array()) {
    std::fprintf(stderr, "error: %s: not a JSON array of cases\n", file.c_str());
    return std::nullopt;
  }
  std::vector<Case> cases;
  for (const Json& item : list) {
    for (const char* key : {"id", "family", "input", "expect", "tol"})
      if (!item.is_object() || !item.contains(key)) {
        std::fprintf(stderr, "error: %s: case %zu: no \"%s\", expected {id, family, input, expect, tol}\n",
                     file.c_str(), cases.size(), key);
        return std::nullopt;
      }
    cases.push_back(
        {item["id"].get<std::string>(), item["family"].get<std::string>(), item["input"], item["expect"], item["tol"]});
  }
  return cases;
}

Check runCase(const Case& c) {
  Check check;
  const auto family = families().find(c.family);
  if (family == families().end()) {
    check.fail("no kernel for this family");
    return check;
  }
  try {
    family->second(c, check);
    if (check.passed() && check.comparisons() == 0) check.fail("nothing was compared");
  } catch (const std::exception& e) {
    check.fail(e.what());
  }
  return check;
}

int verify(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code))
    if (entry.is_regular_file() && entry.path().extension() == ".json") files.push_back(entry.path());
  if (code || files.empty()) {
    std::fprintf(stderr, "error: %s: %s, expected a folder of *.json case files\n", folder.c_str(),
                 code ? code.message().c_str() : "no case files");
    return 2;
  }
  std::sort(files.begin(), files.end());
  std::map<std::string, Score> scores;
  for (const fs::path& file : files) {
    const auto cases = readCases(file);
    if (!cases) return 2;
    for (const Case& c : *cases) {
      const Check check = runCase(c);
      Score& score = scores[c.family];
      ++score.total;
      score.passed += check.passed() ? 1 : 0;
      score.worst = std::max(score.worst, check.worst());
      if (!check.passed()) std::printf("  FAILED %s: %s\n", c.id.c_str(), check.failure().c_str());
    }
  }
  int passed = 0, failed = 0;
  for (const auto& [family, score] : scores) {
    std::printf("%s %d/%d worst error÷tolerance %.3Lg\n", family.c_str(), score.passed, score.total, score.worst);
    passed += score.passed;
    failed += score.total - score.passed;
  }
  std::printf("%d passed, %d failed\n", passed, failed);
  return failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace hapticd::verify

int main(int argc, char** argv) {
  if (argc != 2 || argv[1][0] == '-') {
    std::fprintf(stderr, "usage: verify_cases DIR\n  DIR: a folder of case files, for example tests/cases\n");
    return 2;
  }
  try {
    return hapticd::verify::verify(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 2;
  }
}
