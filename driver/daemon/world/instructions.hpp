// SPDX-License-Identifier: MIT
/// Which processor instructions the inner loops of shapes use: the fastest, or those that give the same bits
/// everywhere.
#pragma once
#include <string>

#include "description/scene.hpp"

namespace hapticd::servo {

/// [main] Sets what the scene wants, before the first shape of the process is made. Plugins look at it once, so all
/// scenes of a process share the first one's choice.
void chooseInstructions(const scene::Servo& servo);

/// [main] Which instructions shapes use here with this scene: "portable", "avx2+fma".
std::string takenInstructions(const scene::Servo& servo);

}  // namespace hapticd::servo
