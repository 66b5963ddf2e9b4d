// SPDX-License-Identifier: MIT
/// What is said of many equal models is said once.
#include "document/alike.hpp"

#include <gtest/gtest.h>

namespace hapticd::document {
namespace {

Problems ofModels(int count, const char* rest) {
  Problems problems;
  for (int i = 0; i < count; ++i)
    report(problems, "scene.yaml", 4 * i + 6, 9, "models[" + std::to_string(i) + "].parameters.stiffness",
           "ball" + std::to_string(i) + rest);
  return problems;
}

TEST(Alike, ManyAreToldOnceWithTheirNumber) {
  const Problems once = withoutAlike(ofModels(200, " pushes with up to 9000 N/m"));
  ASSERT_EQ(once.size(), 1u);
  EXPECT_EQ(once[0].text(),
            "scene.yaml:6:9: models[0].parameters.stiffness: ball0 pushes with up to 9000 N/m "
            "(and the same of 199 more, up to line 802)");
}

TEST(Alike, FewAreToldEach) {
  EXPECT_EQ(withoutAlike(ofModels(3, " pushes")).size(), 3u);
}

TEST(Alike, AnotherNumberKeyOrFileIsAnotherProblem) {
  Problems problems = ofModels(9, " pushes with up to 9000 N/m");
  problems[3].what = "ball3 pushes with up to 9001 N/m";
  problems[4].key = "models[4].plugin";
  problems[5].place.file = "other.yaml";
  EXPECT_EQ(withoutAlike(problems).size(), 4u);
  Problems whole;
  for (int i = 0; i < 9; ++i) report(whole, "scene.yaml", i, 1, "servo.rate", "too low");
  EXPECT_EQ(withoutAlike(whole).size(), 9u);
}

TEST(Alike, TwoNamesThatDifferAreTwoProblems) {
  Problems problems;
  for (int i = 0; i < 9; ++i)
    report(problems, "scene.yaml", i, 1, "models[" + std::to_string(i) + "]",
           "a" + std::to_string(i) + " touches b" + std::to_string(i));
  EXPECT_EQ(withoutAlike(problems).size(), 9u);
}

}  // namespace
}  // namespace hapticd::document
