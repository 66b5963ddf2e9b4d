// SPDX-License-Identifier: MIT
/// Chooses the processor instructions for the inner loops of shapes: the fastest, or those that give the same bits on
/// every machine.
#pragma once
#include <string>

#include "description/scene.hpp"

namespace hapticd::servo {

/// [main] Sets the instructions that the scene asks for. Call it before the first shape of the process is made: plugins
/// read the setting once, so all scenes of a process use the setting of the first scene.
void chooseInstructions(const scene::Servo& servo);

/// [main] Returns the instructions that shapes use on this machine with this scene: "portable" or "avx2+fma".
std::string takenInstructions(const scene::Servo& servo);

}  // namespace hapticd::servo
