// SPDX-License-Identifier: MIT
/// Colour for verdicts on a terminal.
#pragma once
#include <cstdint>
#include <string>

namespace hapticd::cli {

enum class Colour : uint8_t { kGood, kWarning, kBad };

/// [main] Colours the word where standard output is a terminal with colours and NO_COLOR is not set. Verdicts alone
/// have a colour, and the word says the same without it.
std::string coloured(const std::string& word, Colour colour);

}  // namespace hapticd::cli
