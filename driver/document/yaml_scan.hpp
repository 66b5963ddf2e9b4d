// SPDX-License-Identifier: MIT
/// Finds quotes and brackets of a YAML text that are not closed or do not match. It does not parse the text. Its
/// results explain why the parser failed.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace hapticd::document {

struct Mark {
  int line = 0, column = 0;  ///< counted from 1
  char what = 0;
};

struct Scan {
  std::vector<Mark> open;           ///< brackets that are open at the end of the text, the outermost first
  std::optional<Mark> quote;        ///< a quote that is never closed
  std::optional<Mark> long_quote;   ///< the first quote that is closed in another line
  int long_quote_ends = 0;          ///< line in which that quote is closed
  std::optional<Mark> wrong_close;  ///< the first closing bracket that does not match the open one
  std::optional<Mark> wrong_open;   ///< the innermost bracket that is open at `wrong_close`, if there is one
};

/// [any] Scans a whole text.
Scan scanYaml(const std::string& text);

}  // namespace hapticd::document
