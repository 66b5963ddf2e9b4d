// SPDX-License-Identifier: MIT
/// Gives warnings their places in files.
#pragma once
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Finds the line of each warning that has only a key, or the pose of a model, and removes warnings that occur
/// twice.
void placeWarnings(document::Problems& warnings);

}  // namespace hapticd::diagnostics
