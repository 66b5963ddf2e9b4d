// SPDX-License-Identifier: MIT
/// The motion of a kinematic model: CSV with a header t,x,y,z,qw,qx,qy,qz (or t,x,y,z alone).
#pragma once
#include <filesystem>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::scene {

using document::Problems;

/// [main] Reads and checks a path: finite numbers, growing times, unit quaternions (normalised within 1e-3).
std::vector<PathPoint> readKinematicPath(const std::filesystem::path& file, Problems& problems);

/// [main] The same from a text, for tests and fuzzing.
std::vector<PathPoint> parseKinematicPath(const std::string& text, const std::string& file, Problems& problems);

}  // namespace hapticd::scene
