// SPDX-License-Identifier: MIT
/// No closed motion of a hand gives it energy, whatever springs and stiffness it meets, dynamics felt or not.
#include <string>

#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

constexpr double kOff = 0, kFelt = 3;

/// A hand that moves and counts the work that it gets.
class Hand {
 public:
  Hand(Plugin& body, const Vector3d& at) : body_(&body), at_(at) {
    body.search(at);
    force_ = forceOf(body.touch(at));
  }
  void go(const Vector3d& to) {
    const hsp_contact contact = body_->touch(to);
    const Vector3d force = forceOf(contact), normal(contact.normal);
    const double work = .5 * (force + force_).dot(to - at_), outward = force.dot(normal);
    (work > 0 ? given : taken) += std::fabs(work);
    aside = std::max(aside, (force - outward * normal).norm() - outward);
    at_ = to, force_ = force;
  }
  /// Along a straight line by 20 um a tick.
  void line(const Vector3d& to) {
    const Vector3d from = at_;
    const auto steps = static_cast<int>(std::ceil((to - from).norm() / 2e-5));
    for (int i = 1; i <= steps; ++i) go(from + (to - from) * i / steps);
  }
  const Vector3d& force() const { return force_; }

  double given = 0, taken = 0;  ///< [J]
  double aside = -HUGE_VAL;     ///< [N] by how much a part along the surface was greater than the outward one

 private:
  Plugin* body_;
  Vector3d at_, force_;
};

/// Tells whether a closed motion took more than `least` [J] from the hand, and gave no energy and no push aside.
testing::AssertionResult givesNone(const Hand& hand, double least) {
  if (hand.taken > least && hand.given - hand.taken < .01 * hand.taken && hand.aside < 1e-3)
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << "the hand got " << hand.given << " J, gave " << hand.taken
                                     << " J, and was pushed aside by " << hand.aside << " N";
}

/// In rounds, over the rim and back, as in the scene soft-garden: there it got 10.9 mJ of 55.6.
TEST(Energy, AHandThatStrokesAPebbleGetsNone) {
  constexpr int kStrokes = 40'000;
  for (const double offset : {0., .02, .05, .2}) {
    for (const double dynamics : {kOff, kFelt}) {
      for (const double radius : {.0365, .0385}) {
        Plugin pebble("pebble.yaml");
        pebble.set("dynamics", dynamics);
        pebble.set("shear_offset", offset);
        ASSERT_EQ(pebble.activate(), HSP_OK);
        Hand hand(pebble, {radius * std::sin(.9), 0, radius * std::cos(.9) - .025});  // begins and ends in the air
        for (int i = 0; i <= kStrokes; ++i) {
          const double turn = 2 * M_PI * i / kStrokes, angle = .9 * std::cos(3 * turn);
          hand.go({radius * std::sin(angle), .008 * std::sin(2 * turn), radius * std::cos(angle) - .025});
        }
        EXPECT_TRUE(givesNone(hand, 5e-3)) << offset << ", " << dynamics << ", " << radius;
      }
    }
  }
}

/// In where the tissue is soft, along below its surface, and out over the lump, and the other way round.
TEST(Energy, ALoopOverALumpGivesNone) {
  const Vector3d soft(-.02, -.00922, .0148), lump(.0152, -.01128, .0148), up(0, 0, .006);
  for (const double dynamics : {kOff, kFelt}) {
    for (const auto& [id, value] : {std::pair("shear_offset", 0.), {"shear_offset", .05}, {"shear_distance", .006}}) {
      for (const bool back : {false, true}) {
        Plugin tissue("palpation.yaml");
        tissue.set("dynamics", dynamics);
        tissue.set(id, value);
        ASSERT_EQ(tissue.activate(), HSP_OK);
        const Vector3d from = back ? lump : soft, to = back ? soft : lump;
        Hand hand(tissue, from + up);
        for (const Vector3d& corner : {from, to, Vector3d(to + up)}) hand.line(corner);
        EXPECT_TRUE(givesNone(hand, 1e-3)) << dynamics << ", " << id << ", " << back;
      }
    }
  }
}

/// A lump is still felt by a hand that strokes over it: the force along the surface pays for it.
TEST(Energy, AStrokeOverALumpFeelsItsStiffness) {
  const Vector3d soft(-.02, -.00922, .0148), lump(.0152, -.01128, .0148), up(0, 0, .006);
  for (const double dynamics : {kOff, kFelt}) {
    Plugin stroked("palpation.yaml"), pressed("palpation.yaml");
    for (Plugin* tissue : {&stroked, &pressed}) {
      tissue->set("dynamics", dynamics);
      tissue->set("shear_offset", 0.);
      ASSERT_EQ(tissue->activate(), HSP_OK);
    }
    Hand stroking(stroked, soft + up), pressing(pressed, lump + up);
    for (const Vector3d& corner : {soft, lump}) stroking.line(corner);
    pressing.line(lump);
    EXPECT_NEAR(stroking.force().z(), pressing.force().z(), .03 * pressing.force().z()) << dynamics;
  }
}

/// In the crotch of a body whose dynamics are not felt, too, the force is the slope of an energy: what lies beyond is
/// felt whole. The blend of two directions had no energy, and after some strokes nothing of the force was left.
TEST(Energy, AHandThatCrossesACrotchFeelsTheWholeForceBeyond) {
  for (const double y : {-.021, -.019, -.017}) {
    Plugin crossed("branch.ma"), pressed("branch.ma");
    for (Plugin* palm : {&crossed, &pressed}) {
      palm->set("dynamics", kOff);
      ASSERT_EQ(palm->activate(), HSP_OK);
    }
    const Vector3d left(-.012, y, .008), right(.012, y, .008), up(0, 0, .01);
    Hand crossing(crossed, left + up), pressing(pressed, right + up);
    for (int i = 0; i < 4; ++i)
      for (const Vector3d& corner : {left, right, left}) crossing.line(corner);
    crossing.line(right);
    pressing.line(right);
    EXPECT_GT(crossing.force().norm(), .95 * pressing.force().norm()) << y;
    crossing.line(right + up);
    EXPECT_LT(crossing.given - crossing.taken, .01 * crossing.taken);
  }
}

/// A contact that ran dry stays so only until the probe has left.
TEST(Energy, ANewContactFeelsTheWholeForceAgain) {
  for (const double dynamics : {kOff, kFelt}) {
    Plugin pebble("pebble.yaml");
    pebble.set("dynamics", dynamics);
    ASSERT_EQ(pebble.activate(), HSP_OK);
    const Vector3d top(0, 0, .018), rim(.0117, .0117, .006);
    Hand hand(pebble, top);
    hand.line({0, 0, .014});
    const double whole = hand.force().z();
    for (const Vector3d& corner : {top, Vector3d(.02, .02, .008), rim, Vector3d(0, 0, .014), top}) hand.line(corner);
    hand.line({0, 0, .014});
    EXPECT_NEAR(hand.force().z(), whole, 1e-3 * whole) << dynamics;
  }
}

}  // namespace
}  // namespace hapticd::test
