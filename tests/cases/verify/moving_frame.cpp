// SPDX-License-Identifier: MIT
#include "servo/core/frame.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

using Eigen::Vector3d;

void movingFrame(const Case& c, Check& check) {
  const Eigen::Quaterniond q(Eigen::AngleAxisd(number(c.input["angle"]), vector(c.input["axis"]).normalized()));
  const Vector3d origin = vector(c.input["translation"]);
  const hsp_pose pose = {{origin.x(), origin.y(), origin.z()}, {q.w(), q.x(), q.y(), q.z()}, {}, {}};
  const servo::Frame frame = servo::Frame::of(pose);
  const Vector3d p_world = vector(c.input["E"]);
  check.nearVector("E_model", frame.pointToModel(p_world), c.expect["E_model"], number(c.tol["abs"]));

  int transforms = 0;  // of a tick: the probe into each model, a foot and a normal back from each active surface
  for (int model = 0; model < c.input["n_models"].get<int>(); ++model, ++transforms)
    check.isTrue("inverse", frame.pointToModel(p_world).allFinite());
  for (int surface = 0; surface < c.input["m_surfaces"].get<int>(); ++surface, transforms += 2)
    check.isTrue("feet", frame.pointToWorld(p_world).allFinite() && frame.vectorToWorld(p_world).allFinite());
  check.near("transform_count", transforms, c.expect["transform_count"], 0.5);
}

}  // namespace
HAPTICD_VERIFY(moving_frame, movingFrame)
}  // namespace hapticd::verify
