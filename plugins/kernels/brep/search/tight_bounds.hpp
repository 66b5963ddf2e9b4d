// SPDX-License-Identifier: MIT
/// The size of a part as a person would measure it. The boxes of the search are wider, because they enclose control
/// points and turned boxes.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>

#include "kernels/brep/model/model.hpp"

namespace hapticd::brep {

/// [main] Returns the smallest box [m] around all bodies in their places (model frame). It is right to rounding, or too
/// small by at most a thousandth of its diagonal, unless the search proves no foot on a side.
Eigen::AlignedBox3d tightBounds(const Model& model);
/// [main] Returns the box of the body in one place alone. @param place index in Model::placements()
Eigen::AlignedBox3d tightBounds(const Model& model, std::uint32_t place);

}  // namespace hapticd::brep
