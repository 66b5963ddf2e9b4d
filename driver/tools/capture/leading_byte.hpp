// SPDX-License-Identifier: MIT
/// Finds a byte in front of each report of a capture that the file does not know: a 0x00 that a program has put there,
/// as programs on Windows do for devices without report ids, or a report id.
#pragma once
#include <string>

#include "capture/capture.hpp"
#include "codec/wire.hpp"

namespace hapticd::capture {

/// [main] Returns one line, or "" if there is no such byte. The line says what to remove from the capture or which id
/// to give, and which size the reports have without it.
std::string leadingByte(const codec::Wire& wire, const Capture& capture);

}  // namespace hapticd::capture
