// SPDX-License-Identifier: MIT
/// What an engineer meant who wrote a type or a checksum as another language or catalogue does.
#pragma once
#include <string>

namespace hapticd::codec {

/// [main] Of "int24", "s24", "uint8_t", "float": " (did you mean \"i24\"?)", or "".
std::string typeMeant(const std::string& text);

/// [main] Of "CRC-16/XMODEM", "xmodem", "crc16-ccitt": the name that this project has for it, as above.
std::string methodMeant(const std::string& text);

}  // namespace hapticd::codec
