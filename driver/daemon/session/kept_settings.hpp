// SPDX-License-Identifier: MIT
/// What a scene says that a reload cannot change while the servo runs.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"

namespace hapticd::servo {

/// [main] Keys in which the wanted scene differs from the running one, models excepted, in the scenes' own words:
/// "servo.rate", "clients.max_force", "ARM: limits.force".
std::vector<std::string> keptSettings(const scene::Scene& running, const scene::Scene& wanted);

}  // namespace hapticd::servo
