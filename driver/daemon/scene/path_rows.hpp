// SPDX-License-Identifier: MIT
/// Finds the rows of a model's path in its file, so that messages can name them.
#pragma once
#include <filesystem>
#include <optional>

#include "description/scene.hpp"

namespace hapticd::scene {

/// Where a scene gives the path of a model, and the file of this path.
struct PathKey {
  document::Place place;
  std::filesystem::path csv;  ///< empty if the scene no longer has the path
};

/// [main] Reads the scene of the model again, and returns where it gives the path.
PathKey keyOfPath(const Model& model);

/// [main] Returns the line of a row in the file of a path; nothing if the file does not have this row any more.
/// @param row index of the row, counted from 0
/// @param t [s] time in this row
std::optional<int> lineOfRow(const std::filesystem::path& csv, size_t row, double t);

}  // namespace hapticd::scene
