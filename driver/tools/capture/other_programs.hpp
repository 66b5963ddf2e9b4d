// SPDX-License-Identifier: MIT
/// Lines of captures that other programs have written: usbmon of the kernel, and the hex dumps of Wireshark.
#pragma once
#include <optional>
#include <string>

#include "base/result.hpp"

namespace hapticd::capture {

/// What a line of usbmon says: "ffff8881 1234 C Ii:1:004:1 0:1 4 = 0100ff3c".
struct UsbmonLine {
  double time = -1;    ///< [s]
  std::string digits;  ///< hexadecimal digits of the bytes from the device; "" if the line has none of them
};

/// [main] Reads a line of usbmon's text; returns nothing for other lines. Bytes to the device, and control transfers,
/// are left out. The error says that the kernel has not kept all bytes.
std::optional<Result<UsbmonLine>> usbmonLine(const std::string& line);

/// [main] Takes the offset and the column of characters away from a line of a hex dump by Wireshark, such as
/// "0010   01 ff 3c   ..<". @return the offset; nothing if the line is no such line, which is left as it is
std::optional<size_t> takeDumpOffset(std::string& line);

/// [main] Returns advice for a line that Python or a table of decimal numbers has, or "".
std::string formOfProgram(const std::string& line);

}  // namespace hapticd::capture
