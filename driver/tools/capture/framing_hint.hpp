// SPDX-License-Identifier: MIT
/// Why no reports are found in a framed stream: another mark, another escape, or none where there are some.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] One line, "" if the framing is not wrong: for a file with framing, the marks and escapes with which most
/// reports would be good, or what the file's marks find in the capture.
std::string framingHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded);

}  // namespace hapticd::capture
