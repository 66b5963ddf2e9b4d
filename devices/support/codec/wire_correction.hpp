// SPDX-License-Identifier: MIT
/// Guesses which type or checksum is meant by a name from another programming language or catalogue.
#pragma once
#include <string>

namespace hapticd::codec {

/// [main] For a type such as "int24", "s24" or "uint8_t", returns " (did you mean \"i24\"?)", or "" without a guess.
std::string suggestType(const std::string& text);

/// [main] The same for a checksum such as "CRC-16/XMODEM", "xmodem" or "crc16-ccitt", with this project's name.
std::string suggestMethod(const std::string& text);

}  // namespace hapticd::codec
