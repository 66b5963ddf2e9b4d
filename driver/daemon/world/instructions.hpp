// SPDX-License-Identifier: MIT
/// Which processor instructions the inner loops of shapes use: the fastest, or those that give the same bits
/// everywhere.
#pragma once
#include <string>

#include "description/scene.hpp"

namespace hapticd::servo {

/// [main] Before the first shape of the process is made: what the scene wants. Plugins look at it once, so all scenes
/// of a process share the first one's choice.
void chooseInstructions(const scene::Servo& servo);

/// [main] What shapes take here if the scene is as this one: "portable", "avx2+fma".
std::string takenInstructions(const scene::Servo& servo);

}  // namespace hapticd::servo
