// SPDX-License-Identifier: MIT
/// Quotes and brackets of a YAML text: which of them is not closed. Not a parser: it says why one failed.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace hapticd::document {

struct Mark {
  int line = 0, column = 0;  ///< from 1
  char what = 0;
};

struct Scan {
  std::vector<Mark> open;           ///< brackets that are still open at the end of the text, the outermost first
  std::optional<Mark> quote;        ///< opened, and never closed
  std::optional<Mark> long_quote;   ///< the first quote that ends in another line
  int long_quote_ends = 0;          ///< its last line
  std::optional<Mark> wrong_close;  ///< the first closing bracket that does not fit
  std::optional<Mark> wrong_open;   ///< the bracket that is open there, if there is one
};

/// [any]
Scan scanYaml(const std::string& text);

}  // namespace hapticd::document
