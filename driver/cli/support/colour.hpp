// SPDX-License-Identifier: MIT
/// Colours verdicts on a terminal.
#pragma once
#include <cstdint>
#include <string>

namespace hapticd::cli {

enum class Colour : uint8_t { kGood, kWarning, kBad };

/// [main] Returns the word with colour if standard output is a terminal with colours and NO_COLOR is not set, otherwise
/// the plain word. Only verdicts have a colour, and the colour adds nothing to the meaning of the word.
std::string coloured(const std::string& word, Colour colour);

}  // namespace hapticd::cli
