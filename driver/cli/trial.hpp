/// Trying a scene's models: what only a plugin can judge, such as the content of a geometry file.
#pragma once
#include <vector>

#include "scene/problem.hpp"
#include "scene/scene.hpp"

namespace hapticd::cli {

/// [main] Creates and activates every model in a child process, one after the other, and collects what the plugins
/// object to. A crash or a hang becomes a problem too.
/// @param stiffness where the stiffness [N/m] that each model claims goes, in scene order; nullptr: not wanted
scene::Problems tryModels(const scene::Scene& scene, std::vector<double>* stiffness = nullptr);

}  // namespace hapticd::cli
