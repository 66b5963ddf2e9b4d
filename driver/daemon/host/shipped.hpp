// SPDX-License-Identifier: MIT
/// Names of the plugins and modules that belong to hapticd.
#pragma once
#include <string>

#include "description/class_info.hpp"

namespace hapticd::host {

/// [any] True for a plugin or module that ships with hapticd, even if this build lacks it (`driver/demo` builds only
/// two).
bool shipsName(Kind kind, const std::string& name);

}  // namespace hapticd::host
