// SPDX-License-Identifier: MIT
/// Scenes of the test shapes, built without files.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "servo/loop/lockstep.hpp"
#include "world/world.hpp"

namespace hapticd::servo {

inline scene::Model testModel(const std::string& plugin, std::vector<scene::Value> parameters = {}) {
  scene::Model model;
  model.name = plugin;
  model.plugin = plugin;
  model.library = TEST_SHAPES;
  model.parameters = std::move(parameters);
  return model;
}

inline scene::Value number(uint32_t index, uint32_t kind, double value) {
  scene::Value v;
  v.index = index;
  v.kind = kind;
  v.number = value;
  return v;
}

/// A world of the models, with one probe.
inline std::unique_ptr<World> testWorld(const scene::Scene& scene) {
  auto world = World::build(scene, {scene.servo.rate, 1, false}, [](int, const std::string&, const std::string&) {});
  EXPECT_TRUE(world) << (world ? "" : world.error());
  return world ? std::move(*world) : nullptr;
}

inline Probe probeAt(const Vector3d& position, const Vector3d& velocity = Vector3d::Zero()) {
  Probe probe;
  probe.position = position;
  probe.velocity = velocity;
  probe.valid = true;
  return probe;
}

/// One tick of 1 ms with the probe; returns the force.
inline Vector3d tickOnce(World& world, int index, const Probe& probe) {
  world.core().tick(index * 1e-3, index == 0 ? 0 : 1e-3, {&probe, 1});
  return world.core().force(0);
}

}  // namespace hapticd::servo
