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

}  // namespace
}  // namespace hapticd::document
