// SPDX-License-Identifier: MIT
/// Reads tables of numbers from CSV files. Commas separate the fields, and blanks around a field are ignored. Empty
/// lines and lines that begin with # are skipped. The first line may be a header.
#pragma once
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/problem.hpp"

namespace hapticd::document {

/// The rules that a table must keep.
struct CsvRules {
  /// The accepted headers, such as "t,x,y,z". No two of them have the same number of columns.
  std::vector<std::string> headers;
  bool finite = true;  ///< true: nan and inf are errors. In the first column of a growing table they are always errors
  bool growing = false;       ///< true: the first column must grow from row to row
  double largest = HUGE_VAL;  ///< largest magnitude of a finite number
  /// If given: returns what is wrong with a row whose numbers are all valid, or "". It is reported for this column.
  std::string (*wrongIn)(const double* row, size_t columns) = nullptr;
  std::string column_of_wrong{};
};

struct CsvTable {
  size_t columns = 0;
  std::vector<double> values;  ///< row by row
  std::vector<int> lines;      ///< line number of each row in the file, counted from 1

  size_t rows() const { return lines.size(); }
  const double* row(size_t i) const { return values.data() + i * columns; }
};

/// [main] Parses a text. If something breaks the rules, it reports at most twenty problems with line and column, and
/// returns nothing. Below a wrong header, the rows are judged by what its columns are probably meant to be.
std::optional<CsvTable> parseCsv(std::string_view text, const std::string& file, const CsvRules& rules,
                                 Problems& problems);

/// [main] Reads the rows of a file that keep the rules, whatever is wrong with others. Returns nothing if its columns
/// are unknown. The rows are for finding problems, not for use.
std::optional<CsvTable> readSoundRows(const std::filesystem::path& file, size_t max_bytes, const CsvRules& rules);

/// [main] Reads and parses a file of at most `max_bytes`.
std::optional<CsvTable> readCsv(const std::filesystem::path& file, size_t max_bytes, const CsvRules& rules,
                                Problems& problems);

/// [any] Returns a text as a field of a CSV file that others read (RFC 4180): in quotes if it has a comma, quote or
/// line end.
std::string csvField(const std::string& text);

}  // namespace hapticd::document
