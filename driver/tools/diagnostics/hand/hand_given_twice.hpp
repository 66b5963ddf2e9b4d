// SPDX-License-Identifier: MIT
/// Warns of a scene that gives its hand in two places.
#pragma once
#include "document/node.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of a `hand` at the top of a scene beside one in `device` or `devices`, and says which one holds.
void warnOfHandGivenTwice(const document::Node& root, const std::string& file, document::Problems& warnings);

}  // namespace hapticd::diagnostics
