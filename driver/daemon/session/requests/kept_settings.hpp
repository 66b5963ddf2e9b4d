// SPDX-License-Identifier: MIT
/// Finds the settings of a scene that a reload cannot change while the servo runs.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"

namespace hapticd::servo {

/// [main] Returns the keys, except those of models, whose values differ between the running scene and the wanted one,
/// such as "servo.rate", "clients.max_force", "ARM: limits.force".
std::vector<std::string> keptSettings(const scene::Scene& running, const scene::Scene& wanted);

}  // namespace hapticd::servo
