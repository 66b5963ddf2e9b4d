// SPDX-License-Identifier: MIT
/// Which checksum the reports of a capture have, where they do not have that of the device file.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] One line, "" unless checksums are wrong in most reports: another method, byte order or range of bytes, or a
/// checksum that covers the report id.
std::string checksumHint(const codec::Wire& wire, const Decoded& decoded);

}  // namespace hapticd::capture
