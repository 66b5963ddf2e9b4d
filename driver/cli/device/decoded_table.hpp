// SPDX-License-Identifier: MIT
/// Converts a table of `device decode` to one for `device encode`.
#pragma once
#include <cstddef>
#include <string>

namespace hapticd::cli {

struct PlainTable {
  std::string text;     ///< numbers alone, each row on its own line
  size_t left_out = 0;  ///< rows that were not a good report
};

/// [main] Removes the columns in which `device decode` describes a report (report, time, verdict, why), and the rows
/// whose verdict is not good. Returns any other table unchanged.
PlainTable plainTable(const std::string& text);

}  // namespace hapticd::cli
