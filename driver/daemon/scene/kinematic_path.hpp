// SPDX-License-Identifier: MIT
/// Reads the motion of a kinematic model from a CSV file with the header t,x,y,z,qw,qx,qy,qz (or only t,x,y,z).
#pragma once
#include <filesystem>
#include <vector>

#include "description/scene.hpp"
#include "document/csv.hpp"
#include "document/problem.hpp"

namespace hapticd::scene {

using document::Problems;

constexpr size_t kMaxPathBytes = 256u << 20;  ///< enough for an hour of rows at 1 kHz

/// [main] Returns the rules that the file of a path must keep.
const document::CsvRules& kinematicPathRules();

/// [main] Reads a path and checks it: numbers must be finite, times must grow, and quaternions must have length 1
/// within 1e-3; they are normalised.
std::vector<PathPoint> readKinematicPath(const std::filesystem::path& file, Problems& problems);

/// [main] Like readKinematicPath(), but reads a text. For tests and fuzzing.
std::vector<PathPoint> parseKinematicPath(const std::string& text, const std::string& file, Problems& problems);

}  // namespace hapticd::scene
