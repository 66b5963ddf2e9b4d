// SPDX-License-Identifier: MIT
/// The blocks of a device file that describe the arm's mechanism.
#pragma once
#include <string>

#include "device_draft/device_draft.hpp"

namespace hapticd::device_draft {

std::string armOf(const DeviceDraft& draft);    ///< [main] returns the block `arm` of `parameters`
std::string mountOf(const DeviceDraft& draft);  ///< [main] returns the block `mount`

}  // namespace hapticd::device_draft
