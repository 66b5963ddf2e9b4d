// SPDX-License-Identifier: MIT
/// Finds the checksum that the reports of a capture have, if the checksum of the device file does not fit them.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] Returns one line that names another method, byte order or range of bytes, or a checksum that covers the
/// report id. Returns "" unless the checksums of most reports are wrong.
std::string checksumHint(const codec::Wire& wire, const Decoded& decoded);

}  // namespace hapticd::capture
