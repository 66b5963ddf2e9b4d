// SPDX-License-Identifier: MIT
/// Between the world of a scene and the coordinates that its programs of the HDAPI count in (`clients: {origin,
/// frame}`).
#pragma once
#include "facts.hpp"
#include "hapticd/client.h"

namespace hapticd::hd {

/// A state of the daemon as programs see it, still in SI units.
void toProgram(const Facts& facts, hapticd_state& state);

/// A program's force or torque in the axes of the world, and back.
void toWorld(const Facts& facts, double v[3]);
void fromWorld(const Facts& facts, double v[3]);

}  // namespace hapticd::hd
