// SPDX-License-Identifier: MIT
/// Bodies whose dynamics are felt, through the C ABI.
#include <random>

#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

/// `felt` on one of the bodies that ship.
class FeltBody : public Plugin {
 public:
  explicit FeltBody(const std::string& geometry = "soft-plate.yaml", uint32_t probes = 1, double shear = 0)
      : Plugin(geometry) {
    set("dynamics", 3.0);
    set("shear_offset", shear);
    set("tolerance", 1e-12);
    EXPECT_EQ(activate(probes), HSP_OK);
    for (uint32_t i = 0; i < probes; ++i) search({0, 0, .03}, i);
  }
};

struct Hold {
  const char* model;
  Vector3d outside, inside;
};
std::vector<Hold> holds() {
  return {{"soft-plate.yaml", {.013, .021, .0102}, {.013, .021, .006}},
          {"soft-plate.yaml", {.049, .039, .0102}, {.049, .039, .007}},
          {"palpation.yaml", {.018, -.009, .020}, {.018, -.009, .014}},
          {"palpation.yaml", {.010, .004, .020}, {.010, .004, .015}},
          {"pebble.yaml", {.004, .003, .018}, {.004, .003, .010}},
          {"leaf.yaml", {.012, .003, .014}, {.012, .003, .009}},
          {"rope.yaml", {0, .012, .0015}, {0, .0125, -.0015}}};
}

TEST(FeltBody, AHeldPressFeelsWhatABodyWithoutDynamicsDoes) {
  for (const double shear : {0.0, 0.05}) {
    for (const Hold& hold : holds()) {
      Plugin still(hold.model);
      still.set("dynamics", 0.0);
      still.set("shear_offset", shear);
      still.set("tolerance", 1e-12);  // shear springs stand where the foot does
      ASSERT_EQ(still.activate(), HSP_OK);
      FeltBody felt(hold.model, 1, shear);
      still.search({0, 0, .03});
      still.touch(hold.outside);
      felt.touch(hold.outside);
      const Vector3d wanted = forceOf(still.touch(hold.inside));
      ASSERT_GT(wanted.norm(), 1e-3) << hold.model;
      for (int i = 0; i <= 200; ++i) felt.touch(hold.outside + i / 200.0 * (hold.inside - hold.outside));
      for (int i = 0; i < 4000; ++i) felt.touch(hold.inside);
      const Vector3d held = forceOf(felt.touch(hold.inside));
      EXPECT_LT((held - wanted).norm(), 1e-9 * wanted.norm()) << hold.model << " shear " << shear;
      for (int i = 0; i < 3000; ++i) ASSERT_LT((forceOf(felt.touch(hold.inside)) - held).norm(), 1e-12) << hold.model;
    }
  }
}

/// The host silences a plugin whose force grows at a probe that holds still, unless it says so.
TEST(FeltBody, SaysThatItsSurfaceComesUpByItself) {
  FeltBody felt;
  EXPECT_NE(felt.report.flags & HSP_R_JUMPS, 0u);
  EXPECT_NEAR(felt.report.max_jump, 5e-3 * felt.report.max_stiffness, 1e-9);
  Plugin seen;
  seen.set("dynamics", 2.0);
  ASSERT_EQ(seen.activate(), HSP_OK);
  EXPECT_EQ(seen.report.flags & HSP_R_JUMPS, 0u);
}

TEST(FeltBody, PushesHarderWhenPressedFastAndLosesAProbeThatIsPulledAway) {
  FeltBody body;
  for (int i = 0; i <= 40; ++i) body.touch({0, 0, .0102 - 1e-4 * i});  // 0.1 m/s
  const double fast = body.touch({0, 0, .006}).force[2];
  EXPECT_GT(fast, .8 + .02);  // 200 N/m * 4 mm, and 0.6 N s/m * 0.1 m/s
  for (int i = 0; i < 3000; ++i) body.touch({0, 0, .006});
  EXPECT_NEAR(body.touch({0, 0, .006}).force[2], .8, 1e-9);
  const hsp_contact away = body.touch({0, 0, .0085});  // 2.5 mm out in a tick
  EXPECT_EQ(forceOf(away).norm(), 0);
  EXPECT_GT(away.depth_m, 0);  // still below the contour at rest
}

TEST(FeltBody, AProbeThatBeginsInsideFeelsAHeldPressAtOnce) {
  FeltBody body;
  EXPECT_NEAR(body.touch({0, 0, .006}).force[2], .8, 1e-9);
  EXPECT_NEAR(body.touch({0, 0, .006}).force[2], .8, 1e-9);
  EXPECT_NEAR(body.step({Vector3d(.03, .02, .005)}, Vector3d::Zero(), 1e-3, HSP_IN_JUMP)[0].force[2], 1.0, .02);
}

/// An undamped body whose dent of 8 mm swings out to 8 mm.
class Heavy : private TemporaryFile, public Plugin {
 public:
  Heavy()
      : TemporaryFile("heavy.yaml",
                      "format: hapticd-model/2\nmedial:\n  points: [[[-0.03, -0.03, 0], [-0.03, 0.03, 0]], [[0.03, "
                      "-0.03, 0], [0.03, 0.03, 0]]]\n  radius: 0.02\n  stiffness: 200\n  mass: 1\n"),
        Plugin(path()) {
    set("dynamics", 3.0);
    set("contact_ratio", 20.0);
    EXPECT_EQ(activate(), HSP_OK);
    search({0, 0, .03});
  }
};

/// A probe is at the surface from 5 mm outside on. It met at once what had swung out farther: 15 N within 0.1 mm.
TEST(FeltBody, ASurfaceThatSwingsFarOutDoesNotKickAProbeThatComes) {
  Heavy body;
  for (int i = 0; i <= 1000; ++i) body.touch({0, 0, .021 - 9.5e-6 * i});
  for (int i = 0; i <= 1000; ++i) body.touch({0, 0, .0115});
  const double half_swing = M_PI / std::sqrt(200 * 20.0 / 19);
  double before = 0, jump = 0, most = 0;
  for (int i = 0; 1e-3 * i < half_swing + .1; ++i) {
    const double left = std::clamp((half_swing + .02 - 1e-3 * i) / .04, 0.0, 1.0);  // from 8 mm to 4 mm outside
    const double force = forceOf(body.touch({0, 0, .024 + .004 * left})).norm();
    jump = std::max(jump, std::fabs(force - before));
    most = std::max(most, force);
    before = force;
  }
  EXPECT_GT(most, .1);
  EXPECT_LT(jump, 1);
}

TEST(FeltBody, ASecondProbeMeetsTheSurfaceThatTheFirstHasPressed) {
  FeltBody body("soft-plate.yaml", 2);
  for (int i = 0; i <= 50; ++i) body.step({Vector3d(0, 0, .0102 - 1e-4 * i), Vector3d(.002, 0, .0102)});
  for (int i = 0; i < 2000; ++i) body.step({Vector3d(0, 0, .005), Vector3d(.002, 0, .0102)});
  for (int i = 0; i <= 20; ++i) body.step({Vector3d(0, 0, .005), Vector3d(.002, 0, .0102 - 1e-4 * i)});
  EXPECT_EQ(body.step({Vector3d(0, 0, .005), Vector3d(.002, 0, .0082)})[1].force[2], 0);  // in the dent of the first
  for (int i = 0; i <= 32; ++i) body.step({Vector3d(0, 0, .005), Vector3d(.002, 0, .0082 - 1e-4 * i)});
  std::vector<hsp_contact> both;
  for (int i = 0; i < 2000; ++i) both = body.step({Vector3d(0, 0, .005), Vector3d(.002, 0, .005)});
  EXPECT_LT(both[0].force[2], .8);  // alone it is 1 N
  EXPECT_NEAR(both[0].force[2], both[1].force[2], .02);
  EXPECT_GT(both[0].force[2] + both[1].force[2], 1.0);
}

TEST(FeltBody, GoesOnFromWhereItWasSavedWithWhatHasRelaxed) {
  Plugin body, other;
  for (Plugin* plate : {&body, &other}) {
    plate->set("dynamics", 3.0);
    plate->set("relaxation.share", .8);
    plate->set("relaxation.time", .5);
  }
  const auto& state = other.extension<hsp_ext_state>(HSP_EXT_STATE);
  ASSERT_EQ(body.activate(), HSP_OK);
  body.search({0, 0, .03});
  for (int i = 0; i <= 300; ++i) body.touch({0, 0, .0102 - 2e-5 * std::min(i, 200)});
  std::vector<unsigned char> bytes(static_cast<std::size_t>(state.save(body.handle(), nullptr, 0)));
  ASSERT_EQ(state.save(body.handle(), bytes.data(), bytes.size()), static_cast<int64_t>(bytes.size()));
  ASSERT_EQ(state.load(other.handle(), bytes.data(), bytes.size()), HSP_OK);
  ASSERT_EQ(other.activate(), HSP_OK);
  other.search({0, 0, .03});
  for (int i = 0; i < 200; ++i) {
    body.touch({0, 0, .02});
    other.touch({0, 0, .02});
    if (i < 2) continue;
    ASSERT_NEAR(other.energy(), body.energy(), 1e-9 * body.energy()) << i;
  }
}

/// Whatever was felt before a reset, down to which tick looks for nodes that have come to rest.
TEST(FeltBody, IsAfterAResetAsOneThatIsNew) {
  const auto at = [](int i) {  // away for ever shorter times, until the surface has not yet come to rest
    return Vector3d(.004 * std::sin(.02 * i), 0, .0172 + .004 * std::cos(.012 * i + 2e-7 * i * i));
  };
  for (const int before : {1, 503, 1004}) {
    FeltBody used("pebble.yaml"), fresh("pebble.yaml");
    for (int i = 0; i < before; ++i) used.touch(at(i));
    hsp_shape* const shape = used.handle();
    hsp_plugin_entry.classes[0]->reset(shape);
    used.search(at(0));
    for (int i = 0; i < 20'000; ++i)
      ASSERT_EQ(forceOf(used.touch(at(i))), forceOf(fresh.touch(at(i)))) << before << " " << i;
  }
}

/// Work done on the body by a probe that wanders and comes back out, with the mean of the forces at both ends of each
/// step: it never gives more than it got.
TEST(FeltBody, RandomMotionsInAndAlongTheSurfaceMakeNoEnergy) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  for (const char* model : {"soft-plate.yaml", "pebble.yaml", "rope.yaml"}) {
    for (const double speed : {.02, .1, .5, 2.0}) {
      FeltBody body(model);
      const double top = model[0] == 's' ? .0101 : model[0] == 'p' ? .0175 : .0012;
      Vector3d p(0, model[0] == 'r' ? .012 : 0, top), velocity = Vector3d::Zero(), before = Vector3d::Zero();
      const Vector3d home = p;
      double worked = 0, turned_over = 0;
      forceOf(body.touch(p));
      for (int i = 0; i < 20'000; ++i) {
        for (int k = 0; k < 3; ++k) velocity[k] += .1 * speed * normal(engine);
        velocity -= .02 * velocity + 20 * speed * (p - (home - Vector3d(0, 0, .003)));
        const Vector3d next = p + 1e-3 * velocity;
        const Vector3d force = forceOf(body.touch(next));
        worked -= .5 * (force + before).dot(next - p);
        turned_over = std::max(turned_over, std::fabs(worked));
        ASSERT_GT(worked, -1e-4 * turned_over - 1e-9) << model << " " << speed << " " << i;
        p = next;
        before = force;
      }
      EXPECT_GT(turned_over, 1e-3);
    }
  }
}

}  // namespace
}  // namespace hapticd::test
