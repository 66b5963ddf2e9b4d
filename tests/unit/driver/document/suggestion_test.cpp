// SPDX-License-Identifier: MIT
#include "document/suggestion.hpp"

#include <gtest/gtest.h>

namespace hapticd::document {
namespace {

TEST(Suggestion, IsTheNamesThatBeginLikeTheWord) {
  EXPECT_EQ(suggestion("nurbs", {"mat_deformable", "nurbs_rigid"}), " (did you mean \"nurbs_rigid\"?)");
  EXPECT_EQ(suggestion("friction", {"friction_static", "stiffness", "friction_dynamic", "friction_static"}),
            " (did you mean \"friction_dynamic\" or \"friction_static\"?)");
  EXPECT_EQ(suggestion("hand", {"hand_a", "hand_b", "hand_c", "hand_d"}), "") << "too many";
  EXPECT_EQ(suggestion("nur", {"nurbs_rigid"}), "");
}

TEST(Suggestion, IsTheNameWithTheSameWordsInAnotherOrder) {
  EXPECT_EQ(suggestion("static_friction", {"friction_dynamic", "friction_static"}),
            " (did you mean \"friction_static\"?)");
  EXPECT_EQ(suggestion("static_drag", {"friction_static"}), "");
}

TEST(Listed, ShortensLongLists) {
  EXPECT_EQ(listed({"a", "b", "c"}, 3), "a, b, c");
  EXPECT_EQ(listed({"a", "b", "c"}, 2), "a, b, ... (3 in all)");
}

TEST(Suggestion, AListThatIsCutBeginsWithTheNearestNames) {
  const std::vector<std::string> names = {"geometry", "stiffness",   "damping",
                                          "exponent", "depth_scale", "angular_drag"};
  EXPECT_EQ(listedFor("angular_drg", names, 2), "angular_drag, geometry, ... (6 in all)")
      << "the rest in their order, as far as they are equally near";
  EXPECT_EQ(listedFor("drag", names, 1), "angular_drag, ... (6 in all)") << "a part of a name";
  EXPECT_EQ(listedFor("contact_damping", names, 1), "damping, ... (6 in all)") << "a name with more";
  EXPECT_EQ(listedFor("angular_drg", names, 6), listed(names, 6)) << "a whole list keeps its order";
  EXPECT_EQ(listedFor("", names, 1), "damping, ... (6 in all)");
  EXPECT_EQ(listedFor("x", {}), "");
}

}  // namespace
}  // namespace hapticd::document
