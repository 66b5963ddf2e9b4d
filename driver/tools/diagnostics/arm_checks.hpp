// SPDX-License-Identifier: MIT
/// What `hapticd doctor FILE` looks at on one arm.
#pragma once
#include <string>
#include <vector>

#include "diagnostics/doctor_checks.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Whether the arm of a device file is present, who may open it, what happens to its force when the daemon has
/// gone, and whether old reports are noticed. It opens the arm if that is plugged in, and moves nothing.
std::vector<Finding> checkArm(const std::string& file, host::Catalog& catalog);

}  // namespace hapticd::diagnostics
