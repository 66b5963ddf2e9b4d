// SPDX-License-Identifier: MIT
/// Converts between the world of a scene and the coordinates that HDAPI programs of the scene use (`clients: {origin,
/// frame}`).
#pragma once
#include "facts.hpp"
#include "hapticd/client.h"

namespace hapticd::hd {

/// Converts a state of the daemon to the coordinates of programs, still in SI units.
void toProgram(const DeviceFacts& facts, hapticd_state& state);

/// Converts a force or torque from the axes of programs to the axes of the world, and back.
void toWorld(const DeviceFacts& facts, double v[3]);
void fromWorld(const DeviceFacts& facts, double v[3]);

}  // namespace hapticd::hd
