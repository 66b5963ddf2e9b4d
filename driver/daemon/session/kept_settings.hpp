// SPDX-License-Identifier: MIT
/// What a scene says that a reload cannot change while the servo runs.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"

namespace hapticd::servo {

/// [main] Keys, as scenes have them, of everything but models in which the wanted scene differs from the one that runs:
/// "servo.rate", "clients.max_force", "ARM: limits.force".
std::vector<std::string> keptSettings(const scene::Scene& running, const scene::Scene& wanted);

}  // namespace hapticd::servo
