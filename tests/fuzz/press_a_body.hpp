// SPDX-License-Identifier: MIT
/// Uses a soft body as the plugin does, for the fuzzers of its files.
#pragma once
#include <cmath>

#include "kernels/medial/moving_mesh.hpp"
#include "mat_deformable/soft_body.hpp"

namespace hapticd {

/// Traps if a result must not reach an arm.
/// @param size size of the input; drawing takes ten times as long as the rest, so the body is drawn only for one size
/// in sixteen
inline void pressABody(SoftBody& body, size_t size) {
  using Eigen::Vector3d;
  constexpr double kDt = 1e-3;
  FindOptions options;
  options.crease = 1e-3;
  const Vector3d middle = body.bounds().center(), corner = body.bounds().max();
  for (const Vector3d& start : {Vector3d(0, 0, 0), middle, corner, Vector3d(1e9, 0, 0)}) {
    Track track;
    track.last = start;
    for (int tick = 0; tick < 3; ++tick) {
      const Vector3d moved(tick * 1e-3, 0, 0), p = start + moved;
      body.find(p, 0, options, track);
      const Felt felt = body.felt(p, moved, track);
      track.known = true;
      track.last = p;
      if (!track.foot.center.allFinite() || !felt.normal.allFinite() || !std::isfinite(felt.depth)) __builtin_trap();
      if (felt.depth > 0) {
        const medial::BodyForce answer = body.press(p, track.foot, felt, 0.1);
        if (!(answer.force.dot(felt.normal) >= -1e-6 * answer.force.norm())) __builtin_trap();
        const medial::Press press{track.foot.u, track.foot.v, felt.normal, felt.depth, 0.1, track.foot.element};
        body.yield({&press, 1});
      }
      body.nodes().advance(kDt);
    }
  }
  for (size_t i = 0; i < body.nodes().count(); ++i)
    if (!body.nodes().displacement(i).allFinite()) __builtin_trap();
  constexpr size_t kDrawnOne = 16;
  if (size % kDrawnOne == 0) body.contour(body.bounds().diagonal().norm() + 1e-6);  // the coarsest grid of cells
  body.describe("fuzz");
}

}  // namespace hapticd
