// SPDX-License-Identifier: MIT
/// Computes with poses in the form of the HDAPI: 4 x 4 matrices, column-major, with the position in mm at [12..14].
#pragma once
#include "hapticd/client.h"

namespace hapticd::hd {

void toTransform(const hapticd_state& state, double out[16]);

/// Scales the angles of the rotation Ry(a) Rx(b) Rz(c) by scale[0], scale[1] and scale[2]. The position does not
/// change.
void scaleAngles(const double scale[3], double transform[16]);

}  // namespace hapticd::hd
