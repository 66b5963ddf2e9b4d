// SPDX-License-Identifier: MIT
#include "kernels/brep/tree/row_box.hpp"

namespace hapticd::brep {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

AlignedBox3d OrientedBox::axisAligned() const {
  const Vector3d center = frame.transpose() * box.center();
  const Vector3d half = frame.cwiseAbs().transpose() * (0.5 * box.sizes());
  const Vector3d rounding = Vector3d::Constant(1e-14 * (center.cwiseAbs() + half).maxCoeff());
  return {center - half - rounding, center + half + rounding};
}

RowBox rowBox(const OrientedBox& oriented, const BoxTree& tree) {
  const Vector3d center = oriented.frame.transpose() * oriented.box.center() - tree.origin();
  const Vector3d half = 0.5 * oriented.box.sizes();
  // The box is symmetric, so axis 1 may be turned around. Then axis 2 is the cross product of the other two.
  const double turned = oriented.frame.determinant() < 0 ? -1 : 1;
  RowBox row;
  for (int i = 0; i < 3; ++i) {
    row.center[i] = static_cast<float>(center[i]);
    row.first[i] = static_cast<float>(oriented.frame(0, i));
    row.second[i] = static_cast<float>(turned * oriented.frame(1, i));
    // The rounding of an axis adds a share of the other two half sizes. The tree's margin covers the rounding of the
    // center and of the probe.
    row.half[i] = static_cast<float>(half[i] * (1 + 1e-6) + 1e-6 * half.sum() + tree.margin());
  }
  // ratio of radius to half size; above it the shape is so flat that cylinders bound it no better than the box
  constexpr double kLeastRadii = 30;
  if (!(oriented.outer < kLeastRadii * half.maxCoeff())) return row;
  const Vector3d middle = oriented.box.center();
  row.center[3] = static_cast<float>(oriented.focus[0] - middle[0]);
  row.half[3] = static_cast<float>(oriented.focus[1] - middle[2]);
  const double room = 2e-6 * (oriented.outer + half.sum()) + 2 * tree.margin();
  row.first[3] = static_cast<float>(oriented.inner * (1 - 1e-6) - room);
  row.second[3] = static_cast<float>(oriented.outer * (1 + 1e-6) + room);
  return row;
}

}  // namespace hapticd::brep
