// SPDX-License-Identifier: MIT
#include "coordinates.hpp"

#include <Eigen/Geometry>

namespace hapticd::hd {

namespace {

/// Returns the rotation that turns a program's vectors into the world frame.
Eigen::Quaterniond turnOf(const DeviceFacts& facts) {
  return {facts.turn[0], facts.turn[1], facts.turn[2], facts.turn[3]};
}

}  // namespace

void fromWorld(const DeviceFacts& facts, double v[3]) {
  if (facts.is_world) return;
  Eigen::Map<Eigen::Vector3d> mapped(v);
  mapped = turnOf(facts).conjugate() * Eigen::Vector3d(mapped);
}

void toWorld(const DeviceFacts& facts, double v[3]) {
  if (facts.is_world) return;
  Eigen::Map<Eigen::Vector3d> mapped(v);
  mapped = turnOf(facts) * Eigen::Vector3d(mapped);
}

void toProgram(const DeviceFacts& facts, hapticd_state& state) {
  if (facts.is_world) return;
  for (int i = 0; i < 3; ++i) state.position[i] -= facts.origin[i];
  for (double* v : {state.position, state.velocity, state.sent}) fromWorld(facts, v);
  double* q = state.orientation;
  const Eigen::Quaterniond turn = turnOf(facts).conjugate() * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  q[0] = turn.w(), q[1] = turn.x(), q[2] = turn.y(), q[3] = turn.z();
}

}  // namespace hapticd::hd
