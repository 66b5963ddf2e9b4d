// SPDX-License-Identifier: MIT
/// Finds out why a stream with framing shows no reports: other marks, other escapes, or marks or escapes that the file
/// lacks.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] Returns one line, or "" if the framing is right. The line names the marks and escapes with which most reports
/// would be good, or says what the marks of the file find in the capture.
std::string framingHint(const codec::Wire& wire, const Capture& capture, const Decoded& decoded);

}  // namespace hapticd::capture
