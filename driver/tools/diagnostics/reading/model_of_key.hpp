// SPDX-License-Identifier: MIT
/// Finds the model of a scene that a problem is about, from its key.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the index of the model that a key such as "models[3].pose" is about.
std::optional<size_t> modelOf(const std::string& key);

/// [main] Returns the problems of each model, in their order. The time is proportional to the number of problems.
/// @param count number of models; problems of models beyond it are left out
std::vector<document::Problems> problemsOfModels(const document::Problems& problems, size_t count);

}  // namespace hapticd::diagnostics
