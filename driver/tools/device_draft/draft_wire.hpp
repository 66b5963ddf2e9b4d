// SPDX-License-Identifier: MIT
/// The block of a device file that describes the arm's reports.
#pragma once
#include <string>

#include "device_draft/device_draft.hpp"

namespace hapticd::device_draft {

std::string wireOf(const DeviceDraft& draft);  ///< [main] returns the block `wire` of `parameters`

}  // namespace hapticd::device_draft
