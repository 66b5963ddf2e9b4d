// SPDX-License-Identifier: MIT
/// Which values of a scene with problems were read: the kinds of the problems tell it, whatever their words are.
#include "diagnostics/reading/unread_keys.hpp"

#include <gtest/gtest.h>

#include "diagnostics/reading/model_of_key.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Problem;
using document::ProblemKind;

host::ClassInfo plugin() {
  host::ClassInfo info;
  for (const char* id : {"stiffness", "damping"}) info.params.emplace_back().id = id;
  return info;
}

Problem problem(const std::string& key, const std::string& what, ProblemKind kind = ProblemKind::kValue) {
  Problem one;
  one.key = key;
  one.what = what;
  one.kind = kind;
  return one;
}

TEST(UnreadKeys, AMisspeltParameterWasReadAsMeant) {
  const UnreadKeys unread({problem("models[0].parameters.stifness", "in any words", ProblemKind::kMisspeltKey)});
  EXPECT_TRUE(unread.ofModel(0, plugin()).sound());
}

TEST(UnreadKeys, AWrongValueWasNotReadWhateverIsSaidOfIt) {
  const UnreadKeys unread(
      {problem("models[0].parameters.stiffness", "unknown parameter is no number (did you mean \"5\"?)")});
  const UnreadModel model = unread.ofModel(0, plugin());
  EXPECT_TRUE(model.ids.contains("stiffness"));
  EXPECT_FALSE(model.sound());
}

TEST(UnreadKeys, AnUnknownKeyOfTheServoMayStandForGravity) {
  EXPECT_TRUE(UnreadKeys({problem("servo.grvty", "in any words", ProblemKind::kUnknownKey)}).has("servo.gravity"));
  EXPECT_FALSE(UnreadKeys({problem("servo.rate", "unknown key in a value")}).has("servo.gravity"));
}

TEST(UnreadKeys, APathThatIsNotFollowedWasRead) {
  const UnreadKeys unread({problem("models[1].path", "in any words", ProblemKind::kUnusedValue)});
  EXPECT_TRUE(unread.ofModel(1, plugin()).sound());
}

TEST(ProblemsOfModels, GivesEachModelItsOwnInTheirOrder) {
  const document::Problems all = {problem("models[1].pose", "first"), problem("servo.rate", "of none"),
                                  problem("models[0]", "of the other"), problem("models[1].path", "second"),
                                  problem("models[7]", "beyond the models")};
  const std::vector<document::Problems> of_models = problemsOfModels(all, 2);
  ASSERT_EQ(of_models.size(), 2u);
  ASSERT_EQ(of_models[0].size(), 1u);
  EXPECT_EQ(of_models[0][0].what, "of the other");
  ASSERT_EQ(of_models[1].size(), 2u);
  EXPECT_EQ(of_models[1][0].what, "first");
  EXPECT_EQ(of_models[1][1].what, "second");
}

}  // namespace
}  // namespace hapticd::diagnostics
