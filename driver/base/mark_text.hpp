// SPDX-License-Identifier: MIT
/// The text with which a program marks a moment of a run, such as "trial 7 begins".
#pragma once
#include <string>
#include <string_view>

namespace hapticd {

constexpr size_t kMostMarkBytes = 95;  ///< [bytes] longest text: a row of a recording keeps 96, with a zero at the end
constexpr const char* kMarkExpected = "1 to 95 bytes of UTF-8 in one line, without control characters";
static_assert(kMostMarkBytes == 95, "kMarkExpected names the bound");

/// [any] True if the text can be a mark, as kMarkExpected says. Logs, tables and pages show it as it is, so it must not
/// end a line or steer a terminal.
bool isMarkText(std::string_view text);

}  // namespace hapticd
