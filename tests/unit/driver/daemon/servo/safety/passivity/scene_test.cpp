// SPDX-License-Identifier: MIT
/// Real plugins, a hand of mass and spring, and the books: what moving models do is theirs, and no model gives away
/// more than it was given and held.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "scene/load.hpp"
#include "servo/loop/lockstep.hpp"
#include "servo/safety/passivity/controller.hpp"
#include "world/world.hpp"

namespace hapticd::servo {
namespace {

constexpr double kPeriod = 1e-3;

/// A world of one model, given as YAML.
struct Stage {
  explicit Stage(const std::string& model) {
    const auto folder = std::filesystem::temp_directory_path() / "hapticd-passivity";
    std::filesystem::create_directories(folder);
    const auto file = folder / (::testing::UnitTest::GetInstance()->current_test_info()->name() + std::string(".yaml"));
    std::ofstream(file) << "hapticd: 1\nmodels:\n  - " << model;
    host::Catalog catalog;
    scene::Loaded loaded = scene::load(file, catalog, {false, {}});
    for (const document::Problem& problem : loaded.problems) ADD_FAILURE() << problem.text();
    if (!loaded.scene) throw std::runtime_error("no scene");
    auto built = World::build(*loaded.scene, {1 / kPeriod, 1, false, false}, [](int, const auto&, const auto&) {});
    if (!built) throw std::runtime_error(built.error());
    world = std::move(*built);
    lockstep.emplace(world->lockstep());
  }
  /// One tick; the force on the probe.
  Vector3d tick(const Vector3d& p, const Vector3d& v) {
    Probe probe;
    probe.position = p, probe.velocity = v, probe.valid = true;
    const double t = count * kPeriod;
    world->core().publish(t, {&probe, 1});
    lockstep->before(t);
    world->core().tick(t, count++ == 0 ? 0 : kPeriod, {&probe, 1});
    return world->core().force(0);
  }
  double stored() const {
    const host::ShapeInstance& shape = *world->shapes()[0];
    return shape.energy()->stored(shape.handle());
  }
  std::unique_ptr<World> world;
  std::optional<Lockstep> lockstep;
  int count = 0;
};

/// What a hand of 0.2 kg on a spring and damper to `target` went through.
struct Outcome {
  double sampling = 0;       ///< [J] that a wall of this stiffness makes by being computed in ticks: K way^2 / 2 each
  double work = 0;           ///< [J] that the hand did on the model
  double supplied = 0;       ///< [J] that the model did by moving
  double least_book = 0;     ///< [J]
  double dissipated = 0;     ///< by the controller
  double worst_deficit = 0;  ///< [J] most that the model gave beyond what it was given and held
  int contacts = 0;
};

template <class Target>
Outcome hold(Stage& stage, double stiffness, double seconds, const Vector3d& start, const Target& target) {
  Outcome outcome;
  passivity::PassivityController controller(0.2 / kPeriod / 2, 5.0);  // the hand's damper stands for the device's
  Vector3d x = start, v = Vector3d::Zero(), held = Vector3d::Zero();
  double first = 0;
  for (int i = 0; i < seconds / kPeriod; ++i) {
    const Vector3d before = x;
    for (int k = 0; k < 10 && i > 0; ++k) {
      const Vector3d pull = 300 * (target(i * kPeriod) - x) - 5 * v;
      v += (pull + held) / 0.2 * kPeriod / 10;
      x += v * kPeriod / 10;
    }
    outcome.work -= held.dot(x - before);
    if (!held.isZero(0)) outcome.sampling += stiffness * (x - before).squaredNorm() / 2;
    const Vector3d force = stage.tick(x, v);
    const passivity::Exchange exchange = stage.world->core().exchange(0);
    outcome.supplied += exchange.supplied;
    held = controller.update(x, force, kPeriod, exchange);
    outcome.least_book = std::min(outcome.least_book, controller.energy());
    outcome.dissipated = controller.dissipated();
    if (i == 0) first = stage.world->shapes()[0]->energy() != nullptr ? stage.stored() : 0;
    if (stage.world->shapes()[0]->energy() != nullptr)
      outcome.worst_deficit = std::max(outcome.worst_deficit, stage.stored() - first - outcome.work - outcome.sampling);
    outcome.contacts += force.norm() > 0;
  }
  return outcome;
}

const std::string kModels = HAPTICD_SOURCE_DIR "/config/models/";

TEST(MovingModels, APathThatPushesTheHandIsNoViolation) {
  const auto path = std::filesystem::temp_directory_path() / "hapticd-passivity-path.csv";
  std::ofstream(path)
      << "t,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.5,0,0,0,1,0,0,0\n1.5,0,0,0.05,1,0,0,0\n2.5,0,0,0,1,0,0,0\n";
  Stage stage("{name: box, plugin: nurbs_rigid, motion: kinematic, path: " + path.string() +
              ", parameters: {geometry: " + kModels + "box.yaml, stiffness: 1000}}\n");
  const Outcome outcome = hold(stage, 1000, 3, {0, 0, 0.055}, [](double) { return Vector3d(0, 0, 0.045); });
  EXPECT_GT(outcome.contacts, 2000);
  EXPECT_GT(outcome.supplied, 0.01) << "the box pushed the hand back by 50 mm, and let it return";
  EXPECT_GE(outcome.least_book, -1e-9);
  EXPECT_EQ(outcome.dissipated, 0);
}

TEST(MovingModels, APendulumThatSwingsIntoTheHandIsNoViolationAndGivesOnlyWhatItHad) {
  Stage stage(
      "{name: pendulum, plugin: pendulum, parameters: {geometry: " + kModels +
      "sphere.yaml, pivot: [0, 0.25, 0], axis: [0, 0, 1], mass: 0.5, length: 0.25, stiffness: 1000, angle: -0.8}}\n");
  const Outcome outcome = hold(stage, 1000, 6, {0.06, 0, 0}, [](double) { return Vector3d(0.06, 0, 0); });
  EXPECT_GT(outcome.contacts, 100);
  EXPECT_GE(outcome.least_book, -1e-9);
  EXPECT_EQ(outcome.dissipated, 0);
  EXPECT_LT(outcome.work, 0) << "the swing was spent on the hand";
  EXPECT_LT(outcome.worst_deficit, 0.01 * 0.5 * 9.81 * 0.25 * (1 - std::cos(0.8)));
}

TEST(MovingModels, AButtonGivesBackNoMoreThanItWasGiven) {
  Stage stage("{name: button, plugin: push_button, parameters: {geometry: " + kModels +
              "box.yaml, stiffness: 2000}}\n");
  const Outcome outcome = hold(stage, 2000, 10, {0, 0.055, 0}, [](double t) {
    return Vector3d(0, 0.05 - 0.02 * (1 - std::cos(2 * M_PI * 0.5 * t)), 0);
  });
  EXPECT_GT(outcome.contacts, 5000);
  EXPECT_GT(outcome.work, -outcome.sampling);
  EXPECT_LT(outcome.worst_deficit, 1e-4);
}

TEST(MovingModels, ABodyThatIsPushedAwayIsNoViolation) {
  Stage stage("{name: box, plugin: nurbs_rigid, motion: dynamic, parameters: {geometry: " + kModels +
              "box.yaml, stiffness: 1000, mass: 2, gravity: false, tether: 50, drag: 4, angular_drag: 0.01}}\n");
  const Outcome outcome = hold(stage, 1000, 6, {0, 0, 0.055}, [](double t) {
    return Vector3d(0.01, 0, 0.05 - 0.02 * (1 - std::cos(2 * M_PI * 0.5 * t)));
  });
  EXPECT_GT(outcome.contacts, 1000);
  EXPECT_GE(outcome.least_book, -1e-9);
  EXPECT_EQ(outcome.dissipated, 0);
  EXPECT_GT(outcome.work, 0) << "drag was paid for by the hand";
}

}  // namespace
}  // namespace hapticd::servo
