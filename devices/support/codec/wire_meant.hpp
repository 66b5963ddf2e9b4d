// SPDX-License-Identifier: MIT
/// What an engineer meant who wrote a type or a checksum as another language or catalogue does.
#pragma once
#include <string>

namespace hapticd::codec {

/// [main] For "int24", "s24", "uint8_t" or "float" it is " (did you mean \"i24\"?)", or "".
std::string typeMeant(const std::string& text);

/// [main] The same for "CRC-16/XMODEM", "xmodem" or "crc16-ccitt", with the name that this project uses.
std::string methodMeant(const std::string& text);

}  // namespace hapticd::codec
