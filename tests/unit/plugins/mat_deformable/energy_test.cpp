// SPDX-License-Identifier: MIT
/// No closed motion of a hand gives it energy that it would notice, whatever springs and stiffness it meets, dynamics
/// felt or not; and no motion takes the force away from a hand for long.
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

/// Returns whether a closed motion took more than `least` [J] from the hand, and gave it hardly
/// any energy and no push aside.
testing::AssertionResult givesLittle(const Hand& hand, double least) {
  if (hand.taken > least && hand.given - hand.taken < .03 * hand.taken && hand.aside < 1e-3)
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << "the hand got " << hand.given << " J, gave " << hand.taken
                                     << " J, and was pushed aside by " << hand.aside << " N";
}

/// In rounds, over the rim and back, as in the scene soft-garden: there it got 10.9 mJ of 55.6.
TEST(Energy, AHandThatStrokesAPebbleGetsLittle) {
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
        EXPECT_TRUE(givesLittle(hand, 5e-3)) << offset << ", " << dynamics << ", " << radius;
      }
    }
  }
}

/// In where the tissue is soft, along below its surface, and out over the lump, and the other way round.
TEST(Energy, ALoopOverALumpGivesLittle) {
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
        EXPECT_TRUE(givesLittle(hand, 1e-3)) << dynamics << ", " << id << ", " << back;
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

/// A flat slab whose stiffness changes over `width` [m] about x = 0.
std::string slabOf(double soft, double stiff, double width) {
  std::string vertices, stiffness;
  for (const double y : {-.02, .02})
    for (const double x : {-.05, -.5 * width, .5 * width, .05}) {
      vertices += "    - [" + std::to_string(x) + ", " + std::to_string(y) + ", 0, 0.012]\n";
      stiffness += (stiffness.empty() ? "" : ", ") + std::to_string(x < 0 ? soft : stiff);
    }
  return "format: hapticd-model/2\nmedial:\n  vertices:\n" + vertices +
         "  triangles: [[0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6]]\n  stiffness: [" + stiffness +
         "]\n";
}

/// The hand does not put in the work that a bone would need, since the force along the surface is bounded. A stroke
/// found 8 % of its force, for as long as the hand stayed.
TEST(Energy, AHandThatStrokesOntoABoneSoonFeelsIt) {
  const TemporaryFile file("bone.yaml", slabOf(100, 3000, .001));
  for (const double dynamics : {kOff, kFelt}) {
    Plugin limb(file.path());
    limb.set("dynamics", dynamics);
    ASSERT_EQ(limb.activate(), HSP_OK);
    Hand hand(limb, {-.02, 0, .015});
    for (const Vector3d& corner : {Vector3d(-.02, 0, .006), Vector3d(.01, 0, .006)}) hand.line(corner);
    for (int i = 0; i < 1000; ++i) hand.go({.01, 0, .006});
    EXPECT_NEAR(hand.force().z(), 18, .01) << dynamics;
  }
}

/// The stiffness of a mesh has kinks between slabs, and the force along the surface is its slope: it went from nothing
/// to 7.7 N in one tick, and a body at rest was silenced for it.
TEST(Energy, TheForceAlongDoesNotStepBetweenSlabs) {
  for (const double width : {.001, .003, .01}) {
    const TemporaryFile file("limb.yaml", slabOf(200, 3000, width));
    for (const double dynamics : {kOff, kFelt}) {
      Plugin limb(file.path());
      limb.set("dynamics", dynamics);
      ASSERT_EQ(limb.activate(), HSP_OK);
      Hand hand(limb, {-.012, 0, .015});
      hand.line({-.012, 0, .006});
      double step = 0;
      for (int i = 1; i <= 1200; ++i) {
        const Vector3d before = hand.force();
        hand.go({-.012 + 2e-5 * i, 0, .006});
        step = std::max(step, (hand.force() - before).norm());
      }
      EXPECT_LT(step, .8) << width << ", " << dynamics;
    }
  }
}

/// After one bad sample a body at rest had no force, until the hand had left it: it went right through.
TEST(Energy, ABadSampleTakesNoForceAway) {
  struct Case {
    double dynamics, damping, mass;
  };
  for (const Case& one : {Case{kOff, 0, 0}, Case{kFelt, .5, .01}, Case{kFelt, 5, 0}}) {
    for (const int lost : {1, 10, 40}) {
      const TemporaryFile file("plate.yaml", slabOf(300, 300, .01) + "  damping: " + std::to_string(one.damping) +
                                                 "\n  mass: " + std::to_string(one.mass) + "\n");
      Plugin plate(file.path());
      plate.set("dynamics", one.dynamics);
      ASSERT_EQ(plate.activate(), HSP_OK);
      Hand hand(plate, {.01, 0, .015});
      hand.line({.01, 0, .004});
      for (int i = 0; i < 1000; ++i) hand.go({.01, 0, .004});
      EXPECT_NEAR(hand.force().z(), 2.4, .01);
      for (int i = 0; i < lost; ++i) plate.step({{.01, 0, .004}}, Vector3d::Zero(), 1e-3, HSP_IN_INVALID);
      for (int i = 1; i <= 300; ++i) {  // a hand presses on at 10 mm/s
        hand.go({.01, 0, .004 - 1e-5 * i});
        EXPECT_NEAR(hand.force().z(), 2.4 + 3e-3 * i, .3) << one.dynamics << ", " << one.mass << ", " << lost;
      }
    }
  }
}

/// One account serves all hands on a felt body: one that went in rounds took the force away from one that held still.
TEST(Energy, AHandThatHoldsStillKeepsItsForceBesideAnother) {
  Plugin pebble("pebble.yaml");
  pebble.set("dynamics", kFelt);
  pebble.set("shear_offset", .2);
  ASSERT_EQ(pebble.activate(2), HSP_OK);
  const Vector3d still(0, 0, .008);
  for (uint32_t i = 0; i < 2; ++i) pebble.search(still, i);
  double alone = 0, least = HUGE_VAL;
  for (int i = 0; i < 20'000; ++i) {
    const double turn = 2 * M_PI * 1e-3 * i;
    const Vector3d round(.012 + .004 * std::cos(turn), 0, .004 - .003 * std::sin(turn));
    const double force = forceOf(pebble.step({still, i < 1000 ? Vector3d(0, 0, .1) : round})[0]).norm();
    (i < 1000 ? alone : least) = i < 1000 ? force : std::min(least, force);
  }
  EXPECT_GT(alone, .1);
  EXPECT_GT(least, .6 * alone);  // the other hand moves the surface
}

/// Returns what a hand gets in its last round over a pebble on which another one rests, after `presses`, each of which
/// left far away in one tick [J].
double gotAfter(int presses) {
  constexpr int kRounds = 6;
  Plugin pebble("pebble.yaml");
  pebble.set("dynamics", kFelt);
  pebble.activate(2);
  const Vector3d still(0, 0, .0145), top(.004, 0, .0185), deep(.004, 0, .014), far(.004, 0, .03);
  for (uint32_t i = 0; i < 2; ++i) pebble.search(i == 0 ? still : top, i);
  Vector3d at = top, force = Vector3d::Zero();
  double got = 0;
  const auto go = [&](const Vector3d& to) {
    const Vector3d next = forceOf(pebble.step({still, to})[1]);
    got += std::max(0., .5 * (force + next).dot(to - at));
    at = to, force = next;
  };
  const auto line = [&](const Vector3d& to) {
    const Vector3d from = at;
    const auto steps = static_cast<int>(std::ceil((to - from).norm() / 2e-5));
    for (int i = 1; i <= steps; ++i) go(from + (to - from) * i / steps);
  };
  for (int i = 0; i < presses; ++i) {
    line(deep);
    go(far);
    go(top);
  }
  for (int i = 0; i < kRounds; ++i) {
    got = 0;
    for (const Vector3d& corner : {Vector3d(.02, .02, .008), Vector3d(.0117, .0117, .006), deep, top}) line(corner);
  }
  return got;
}

/// A hand that leaves in one tick has got the work on the way to the surface. If nobody counted it, each such press
/// would leave a credit with the account that all hands share, as long as one of them rests there.
TEST(Energy, AHandThatLeavesInATickLeavesNoCredit) {
  const double usual = gotAfter(0);
  EXPECT_GT(usual, 1e-3);
  EXPECT_NEAR(gotAfter(60), usual, 1e-3 * usual);
}

}  // namespace
}  // namespace hapticd::test
