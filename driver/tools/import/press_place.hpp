// SPDX-License-Identifier: MIT
/// Chooses where a hand can press a model that nobody has seen yet.
#pragma once
#include <Eigen/Geometry>

#include "import/triangles.hpp"

namespace hapticd::importing {

struct PressPlace {
  Eigen::AlignedBox3d box;  ///< [m] around the triangles
  Eigen::Vector3d normal;   ///< an axis; the hand presses against it
  Eigen::Vector3d point;    ///< [m] on the surface: the first that the hand meets
  bool faces_hand = true;   ///< whether the outside of the surface is there
  /// Returns the middle of that side of the box from which the hand comes.
  Eigen::Vector3d middleOfSide() const { return box.center() + 0.5 * normal.cwiseProduct(box.sizes()); }
};

/// [main] Returns a place near the middle of a side, where the surface is level and no rim is near. The side toward the
/// user (z) is taken unless another one shows far more of the surface.
PressPlace pressPlace(const Triangles& mesh);

}  // namespace hapticd::importing
