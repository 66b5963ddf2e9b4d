// SPDX-License-Identifier: MIT
/// The table of `device decode` as one for `device encode`.
#pragma once
#include <cstddef>
#include <string>

namespace hapticd::cli {

struct PlainTable {
  std::string text;     ///< numbers alone, each row in its line
  size_t left_out = 0;  ///< rows that were no good report
};

/// [main] Without the columns in which `device decode` says what it thinks of a report (report, time, verdict, why),
/// and without the rows that it did not find good. Any other table stays as it is.
PlainTable plainTable(const std::string& text);

}  // namespace hapticd::cli
