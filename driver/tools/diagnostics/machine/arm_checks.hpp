// SPDX-License-Identifier: MIT
/// The checks that `hapticd doctor FILE` makes on one arm.
#pragma once
#include <string>
#include <vector>

#include "diagnostics/machine/doctor_checks.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Checks whether the arm of a device file is present, who may open it, what happens to its force when the
/// daemon has gone, and whether old reports are noticed. Opens the arm if it is plugged in, and moves nothing.
std::vector<Finding> checkArm(const std::string& file, host::Catalog& catalog);

}  // namespace hapticd::diagnostics
