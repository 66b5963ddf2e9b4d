// SPDX-License-Identifier: MIT
/// "Model only what a scene requires": no function of what a scene does not ask for
/// is entered in a tick. Every check has
/// its opposite beside it, a scene that does ask.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

#include "census.hpp"
#include "scene/load.hpp"
#include "servo/loop/loop.hpp"
#include "world/world.hpp"

namespace hapticd::servo {
namespace {

constexpr const char* kDriver = "needed_test";  ///< the driver's part of a tick lies in this program
using test::Census;

void quiet(int, const std::string&, const std::string&) {}

/// A shipped scene, set up as `hapticd run --virtual-time` does it, `ticks` behind its start.
struct Running {
  explicit Running(const std::string& name, const std::string& device = "", int ticks = 1500) {
    host::Catalog catalog(host::SearchPath::standard());
    const std::string folder = HAPTICD_SOURCE_DIR "/config/";
    scene::Loaded loaded =
        scene::load(folder + "scenes/" + name, catalog, {true, device.empty() ? "" : folder + "devices/" + device});
    EXPECT_TRUE(loaded.scene) << name;
    scene = *loaded.scene;
    auto built = World::build(scene, {.rate = scene.servo.rate}, quiet);
    EXPECT_TRUE(built) << (built ? "" : built.error());
    world = std::move(*built);
    for (const scene::Device& described : scene.devices) {
      auto arm = Arm::open(described, scene.servo, {scene.servo.rate, world->needsVelocity()}, quiet);
      EXPECT_TRUE(arm) << (arm ? "" : arm.error());
      EXPECT_TRUE((*arm)->start(0, scene.servo.gravity));
      arms.push_back(std::move(*arm));
    }

    world->core().serve(usesOf(arms));
    lockstep = std::make_unique<Lockstep>(world->lockstep());
    for (int i = 0; i < ticks; ++i) tick();
  }

  /// What Loop::tick does.
  void tick() {
    const double dt = count == 0 ? 0 : 1 / scene.servo.rate, t = static_cast<double>(count) / scene.servo.rate;
    const auto now = static_cast<Nanoseconds>(t * 1e9);
    std::vector<Probe> probes;
    for (const auto& arm : arms) probes.push_back(arm->read(now, dt));
    world->core().publish(t, probes);
    lockstep->before(t);
    world->core().tick(t, dt, probes);
    for (uint32_t i = 0; i < arms.size(); ++i) {
      arms[i]->carryWeight(world->core().present() > 0);
      arms[i]->write(now, dt, world->core().force(i), world->core().torque(i), world->core().exchange(i));
    }
    ++count;
  }

  /// The functions of one tick in contact, with a search.
  Census census() {
    const int period = static_cast<int>(scene.servo.rate / 200);
    while (count % period != 0) tick();
    const Census counted = Census::of([&] { tick(); });
    EXPECT_TRUE(world->core().contact(0, 0).world.depth_m > 0) << "the hand does not touch the model";
    return counted;
  }

  scene::Scene scene;
  std::unique_ptr<World> world;
  Arms arms;
  std::unique_ptr<Lockstep> lockstep;
  int count = 0;
};

class NotNeeded : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Census::kPossible) GTEST_SKIP() << "functions cannot be noted here";
  }
};

/// Of a shipped scene; counted once.
const Census& censusOf(const std::string& name) {
  static std::map<std::string, Census> known;
  const auto found = known.find(name);
  return found != known.end() ? found->second : known[name] = Running(name).census();
}

TEST_F(NotNeeded, ACensusSeesWhatRuns) {
  const Census& census = censusOf("sphere.yaml");
  EXPECT_TRUE(census.ran("nurbs_rigid.so", "trace::Tracer::step")) << census.text("nurbs_rigid.so");
  EXPECT_TRUE(census.ran(kDriver, "servo::Core::tick")) << census.text(kDriver);
}

/// The two scenes differ in what is asked for: `with` runs functions of that name in `object`, `without` none.
void expectOnlyIn(const char* with, const char* without, const char* object, const char* name) {
  const Census &asked = censusOf(with), &other = censusOf(without);
  EXPECT_TRUE(asked.ran(object, name)) << with << " does not run what the test looks for";
  EXPECT_FALSE(other.ran(object, name)) << without << " runs:\n" << other.text(object, name);
}

TEST_F(NotNeeded, NoEstimatorWithoutDamping) {
  expectOnlyIn("teapot.yaml", "sphere.yaml", kDriver, "velocity::");
}

TEST_F(NotNeeded, NoIntegratorForStaticModels) {
  expectOnlyIn("moving-box.yaml", "box.yaml", "nurbs_rigid.so", "dynamics::");
  expectOnlyIn("moving-box.yaml", "box.yaml", "nurbs_rigid.so", "DynamicBody");
  EXPECT_TRUE(Running("moving-box.yaml", "", 1).world->core().models()[0].moves);
  EXPECT_FALSE(Running("box.yaml", "", 1).world->core().models()[0].moves);
}

TEST_F(NotNeeded, NoTransformForModelsAtTheIdentity) {
  Running placed("teapot.yaml"), at_origin("sphere.yaml");
  EXPECT_EQ(placed.world->core().transforms(), 3u);
  EXPECT_EQ(at_origin.world->core().transforms(), 0u);
  EXPECT_TRUE(at_origin.world->core().contact(0, 0).traced);
}

TEST_F(NotNeeded, NoRationalArithmeticForPolynomialPatches) {
  const Census &polynomial = censusOf("teapot.yaml"), &rational = censusOf("sphere.yaml");
  // The third argument of the kernel says whether it divides by a weight; see kernels/spline/kernel_set.inl.
  EXPECT_TRUE(polynomial.ran("nurbs_rigid.so", "evaluateTable<4, 4, false, 2>")) << polynomial.text("nurbs_rigid.so");
  EXPECT_FALSE(polynomial.ran("nurbs_rigid.so", ", true, 1>") || polynomial.ran("nurbs_rigid.so", ", true, 2>"));
  EXPECT_TRUE(rational.ran("nurbs_rigid.so", ", true, 2>")) << rational.text("nurbs_rigid.so", "evaluate");
  EXPECT_FALSE(rational.ran("nurbs_rigid.so", ", false, 1>") || rational.ran("nurbs_rigid.so", ", false, 2>"));
}

TEST_F(NotNeeded, NoTorqueForAnArmOfThreeJoints) {  // see Core.ServesNoTorqueToArmsThatOnlyPush
  Running pushes("sphere.yaml", "", 1), turns("sphere.yaml", "simulated-sarcos.yaml", 1);
  EXPECT_FALSE(usesOf(pushes.arms).torque);
  EXPECT_TRUE(usesOf(turns.arms).torque);
}

TEST_F(NotNeeded, NoPassivityControllerWhereItIsSwitchedOff) {
  EXPECT_FALSE(censusOf("sphere.yaml").ran(kDriver, "passivity::PassivityController"));
  EXPECT_TRUE(censusOf("small-teapot.yaml").ran(kDriver, "passivity::PassivityController"));
}

TEST_F(NotNeeded, NoFrictionUniteOrTextureWhereNothingAsksForThem) {
  const Census& census = censusOf("sphere.yaml");
  for (const char* name : {"contact::Friction", "uniteParts", "texture", "crossSide"})
    EXPECT_FALSE(census.ran("nurbs_rigid.so", name)) << census.text("nurbs_rigid.so", name);
  for (const char* name :
       {"MotorHeat", "Admittance", "limitPower", "limitImpulse", "workspaceFade", "MinimumJerk", "Path::at"})
    EXPECT_FALSE(census.ran(kDriver, name)) << census.text(kDriver, name);
}

}  // namespace
}  // namespace hapticd::servo
