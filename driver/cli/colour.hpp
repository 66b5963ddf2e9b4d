// SPDX-License-Identifier: MIT
/// Colour for verdicts on a terminal.
#pragma once
#include <cstdint>
#include <string>

namespace hapticd::cli {

enum class Colour : uint8_t { kGood, kWarning, kBad };

/// [main] The word in a colour where standard output is a terminal that has some and NO_COLOR is not set; otherwise as
/// it is. Verdicts alone have a colour, and the word says the same without it.
std::string coloured(const std::string& word, Colour colour);

}  // namespace hapticd::cli
