// SPDX-License-Identifier: MIT
/// Poses as the HDAPI has them: 4 x 4, column-major, the position in mm at [12..14].
#pragma once
#include "hapticd/client.h"

namespace hapticd::hd {

void toTransform(const hapticd_state& state, double out[16]);

/// The same place, with the angles of the rotation scaled: it is Ry(a) Rx(b) Rz(c), and becomes that of a scale[0] and
/// so on.
void scaleAngles(const double scale[3], double transform[16]);

}  // namespace hapticd::hd
