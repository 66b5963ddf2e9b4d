// SPDX-License-Identifier: MIT
/// Several models at once, through the servo core in virtual time: what moves, what stands, and a hand between them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "kernels/dynamics/oscillator.hpp"
#include "scene/load.hpp"
#include "servo/loop/lockstep.hpp"
#include "servo/velocity/probe_velocity.hpp"
#include "world/world.hpp"

namespace hapticd::test {
namespace {

using Eigen::Vector3d;
namespace fs = std::filesystem;

const std::string kBox = "geometry: " HAPTICD_SOURCE_DIR "/config/models/box.yaml";
const std::string kBall = "geometry: " HAPTICD_SOURCE_DIR "/config/models/sphere.yaml";

/// A scene in virtual time.
class Scene {
 public:
  Scene(const std::string& models, double rate) : dt_(1 / rate) {
    const fs::path file = fs::temp_directory_path() / ("hapticd-moving-" + std::to_string(::getpid()) + ".yaml");
    std::ofstream(file) << "hapticd: 1\nservo: {rate: " << rate << "}\nmodels:\n" << models;
    host::Catalog catalog{host::SearchPath{{PLUGINS}, {}}};
    auto loaded = scene::load(file, catalog, {false, {}});
    fs::remove(file);
    for (const document::Problem& problem : loaded.problems) ADD_FAILURE() << problem.text();
    auto world = servo::World::build(*loaded.scene, {rate, 1, false},
                                     [](int level, const std::string&, const std::string& text) {
                                       if (level > HSP_LOG_DEBUG) ADD_FAILURE() << text;
                                     });
    EXPECT_TRUE(world) << world.error();
    world_ = std::move(*world);
    lockstep_.emplace(world_->lockstep());
    if (world_->needsVelocity()) estimator_ = *servo::makeEstimator(loaded.scene->servo.velocity, rate);
  }
  /// One tick with the probe at `position` [m]; the force on it [N].
  Vector3d tick(const Vector3d& position) {
    servo::Probe probe;
    probe.valid = true;
    probe.position = position;
    const double t = dt_ * ticks_, dt = ticks_ == 0 ? 0 : dt_;
    if (estimator_) probe.velocity = estimator_->update(position, dt);
    world_->core().publish(t, {&probe, 1});
    lockstep_->before(t);
    world_->core().tick(t, dt, {&probe, 1});
    ++ticks_;
    return world_->core().force(0);
  }
  Vector3d force(uint32_t model) const { return Vector3d(world_->core().contact(model, 0).world.force); }
  Vector3d position(uint32_t model) const { return Vector3d(world_->core().models()[model].pose.position); }
  Vector3d velocity(uint32_t model) const { return Vector3d(world_->core().models()[model].pose.linear); }

 private:
  double dt_;
  int64_t ticks_ = 0;
  std::unique_ptr<servo::World> world_;
  std::optional<servo::Lockstep> lockstep_;
  std::optional<servo::VelocityEstimator> estimator_;
};

/// A hand of 0.5 kg on a spring and a damper to where it wants to be, moved exactly between ticks.
class Hand {
 public:
  Hand(const Vector3d& at, double dt) : x_(at), step_(dynamics::oscillatorStep(0.5, 8, kSpring, dt)) {}
  const Vector3d& position() const { return x_; }
  double speed() const { return v_.norm(); }
  void pushedBy(const Vector3d& force, const Vector3d& target) {
    const Vector3d rest = target + force / kSpring;
    Vector3d from_rest = x_ - rest;
    dynamics::advance(step_, from_rest, v_);
    x_ = rest + from_rest;
  }

 private:
  static constexpr double kSpring = 200;
  Vector3d x_, v_{0, 0, 0};
  dynamics::OscillatorStep step_;
};

TEST(MovingWorlds, AProbePressesABoxAgainstAWallAndFeelsBoth) {
  // the wall's top is y = 0; the box stands above it, its side of 0.1 m; the probe sinks into both at their common face
  Scene scene(
      "  - {name: wall, plugin: nurbs_rigid, pose: {position: [0, -0.05, 0.05]}, parameters: {" + kBox +
          ", stiffness: 1500, damping: 3}}\n"
          "  - name: box\n    plugin: nurbs_rigid\n    motion: dynamic\n    pose: {position: [0.0, 0.0, 0.1]}\n"
          "    parameters: {" +
          kBox +
          ", stiffness: 1000, damping: 3, mass: 0.3, gravity: false, tether: 100, drag: 2, joint: slider, axis: "
          "[0, 0, 1]}\n",
      1000);
  Hand hand({0, 0.01, 0.03}, 1e-3);
  double late = 0;
  Vector3d force = Vector3d::Zero();
  for (int i = 0; i < 12'000; ++i) {
    const double s = std::min(i / 2000.0, 1.0);
    force = scene.tick(hand.position());
    ASSERT_TRUE(force.allFinite());
    ASSERT_LT((force - scene.force(0) - scene.force(1)).norm(), 1e-12) << "the hand feels the sum";
    hand.pushedBy(force, {0, 0.01 - 0.03 * s, 0.03 + 0.05 * s});
    if (i > 10'000) late = std::fmax(late, hand.speed());
  }
  EXPECT_GT(scene.force(0).y(), 1) << "the wall holds it up";
  EXPECT_LT(scene.force(1).z(), -0.5) << "the box holds it back";
  EXPECT_NEAR(scene.position(1).z() - 0.1, -scene.force(1).z() / 100, 2e-3) << "as far as its tether lets it";
  EXPECT_LT(late, 2e-3) << "at rest";
}

TEST(MovingWorlds, TwoMovingModelsSqueezedApartStaySymmetric) {
  std::string models;
  for (const char* side : {"-0.0498", "0.0498"})
    models += std::string("  - name: box") + (side[0] == '-' ? "L" : "R") +
              "\n    plugin: nurbs_rigid\n    motion: dynamic\n    pose: {position: [" + side +
              ", 0, 0]}\n    parameters: {" + kBox +
              ", stiffness: 1000, mass: 0.2, gravity: false, tether: 50, drag: 2, joint: slider, axis: [1, 0, 0]}\n";
  Scene scene(models, 1000);
  for (int i = 0; i < 6000; ++i) {
    const Vector3d force = scene.tick({0, 0.0, 0});
    ASSERT_LT(std::fabs(force.x()), 0.21);
    if (i > 4000) {
      ASSERT_NEAR(force.x(), 0, 1e-6);
      ASSERT_LT(scene.velocity(0).norm(), 1e-6);
    }
  }
  EXPECT_NEAR(scene.position(0).x(), -scene.position(1).x(), 1e-9);
  EXPECT_LT(scene.position(0).x(), -0.0498) << "pushed aside";
}

TEST(MovingWorlds, AButtonAPendulumAndABodyShareAScene) {
  Scene scene("  - {name: button, plugin: push_button, pose: {position: [-0.2, 0, 0]}, parameters: {" + kBox +
                  ", stiffness: 6000}}\n"
                  "  - {name: pendulum, plugin: pendulum, parameters: {" +
                  kBall +
                  ", pivot: [0, 0.25, 0], axis: [0, 0, 1], mass: 0.5, length: 0.25, damping: 0.02}}\n"
                  "  - name: box\n    plugin: nurbs_rigid\n    motion: dynamic\n    pose: {position: [0.2, 0, 0]}\n"
                  "    parameters: {" +
                  kBox + ", mass: 0.1, gravity: false, tether: 20, drag: 1, angular_drag: 1e-4}\n",
              1500);
  Hand hand({-0.2, 0.08, 0}, 1 / 1500.0);
  double most[3] = {0, 0, 0};
  for (int i = 0; i < 15'000; ++i) {
    // down on the button, through the pendulum's ball, into the box's side
    const double s = i / 15'000.0;
    const Vector3d target = s < 0.3 ? Vector3d(-0.2, 0.08 - 0.15 * s, 0) : Vector3d(-0.4 + 0.8 * s, 0.03, 0);
    const Vector3d force = scene.tick(hand.position());
    ASSERT_TRUE(force.allFinite()) << i;
    ASSERT_LT(force.norm(), 60) << i;
    for (uint32_t m = 0; m < 3; ++m) most[m] = std::fmax(most[m], scene.force(m).norm());
    hand.pushedBy(force, target);
  }
  for (const double force : most) EXPECT_GT(force, 0.05);
  EXPECT_LT((scene.position(2) - Vector3d(0.2, 0, 0)).norm(), 0.5);
}

TEST(MovingWorlds, AHandPushesABodyOfAnyMassWithoutTremor) {
  for (double mass = 1e-6; mass < 200; mass *= 10) {
    Scene scene("  - name: box\n    plugin: nurbs_rigid\n    motion: dynamic\n    parameters: {" + kBox +
                    ", stiffness: 1000, damping: 2, mass: " + std::to_string(mass) +
                    ", gravity: false, tether: 20, drag: 2, joint: slider, axis: [0, 1, 0]}\n",
                1000);
    Hand hand({0.01, 0.06, 0.01}, 1e-3);
    double late = 0;
    for (int i = 0; i < 10'000; ++i) {
      const Vector3d force = scene.tick(hand.position());
      hand.pushedBy(force, {0.01, 0.03, 0.01});
      if (i > 8000) late = std::fmax(late, hand.speed());
    }
    EXPECT_LT(late, mass < 2 ? 2e-3 : 0.05) << mass;
    EXPECT_LT(scene.position(0).y(), 0) << mass;
  }
}

}  // namespace
}  // namespace hapticd::test
