// SPDX-License-Identifier: MIT
#include "kernels/medial/influence.hpp"
#include "kernels/medial/skeleton.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

/// A flat plate of constant radius as a 5 x 5 grid.
medial::Skeleton plate(double length, double width, double radius) {
  medial::SkeletonGrid grid;
  grid.count = {5, 5};
  for (int i = 0; i < 25; ++i) {
    grid.points.emplace_back(length * (i / 5) / 4, width * (i % 5) / 4, 0);
    grid.radius.push_back(radius);
  }
  return medial::Skeleton(grid);
}

void matPlate(const Case& c, Check& check) {
  const Json& in = c.input;
  const Eigen::Vector3d q(number(in["Q"][0]), number(in["Q"][1]), number(in["Q"][2]));
  const medial::Skeleton skeleton = plate(number(in["L"]), number(in["W"]), number(in["r"]));
  const medial::SkeletonFoot foot = skeleton.search(q, {});
  const medial::Split split = medial::splitDepth(foot.depth, number(in["g"]));
  const double tolerance = number(c.tol["abs"]);
  check.near("delta", foot.depth, c.expect["delta"], tolerance);
  check.near("u", foot.u, c.expect["u"], number(c.tol["uv_abs"]));
  check.near("v", foot.v, c.expect["v"], number(c.tol["uv_abs"]));
  check.nearVector("direction", foot.normal, c.expect["direction"], tolerance);
  check.near("skeleton_shift", split.skeleton, c.expect["skeleton_shift"], tolerance);
  check.near("radius_change", split.radius, c.expect["radius_change"], tolerance);
  check.near("contact_contour_shift", split.skeleton + split.radius, c.expect["contact_contour_shift"], tolerance);
  check.near("opposite_contour_shift", split.radius - split.skeleton, c.expect["opposite_contour_shift"], tolerance);
}

}  // namespace
HAPTICD_VERIFY(mat_plate, matPlate)
}  // namespace hapticd::verify
