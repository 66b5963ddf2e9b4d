// SPDX-License-Identifier: MIT
/// What `hapticd doctor FILE` looks at on one arm.
#pragma once
#include <string>
#include <vector>

#include "diagnostics/doctor_checks.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Whether the arm of a device file is there, who may open it, what becomes of its force when there is no daemon
/// any more, and whether old reports are noticed. Opens the arm if it is plugged in; moves nothing.
std::vector<Finding> checkArm(const std::string& file, host::Catalog& catalog);

}  // namespace hapticd::diagnostics
