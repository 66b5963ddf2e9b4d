// SPDX-License-Identifier: MIT
/// Separates the problems of a model file, which its plugin reports in one message.
#pragma once
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Takes several problems of a model file out of the message about its model, and adds each at its own place in
/// that file. The message then says only how many there are.
void separateModelFiles(document::Problems& problems);

/// [main] Does the same with warnings, each of which says one thing about a model file: it moves to its place there.
void placeInModelFiles(document::Problems& warnings);

}  // namespace hapticd::diagnostics
