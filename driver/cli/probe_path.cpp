#include "cli/probe_path.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/regular_file.hpp"

namespace hapticd::cli {

namespace {

constexpr std::string_view kHeader3 = "t,x,y,z", kHeader6 = "t,x,y,z,qw,qx,qy,qz";
constexpr size_t kMostColumns = 8;
constexpr size_t kMaxBytes = size_t{4} << 30;  ///< ten hours at 1 kHz

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.back() == '\r' || text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  return text;
}

std::string without(std::string_view text, char unwanted) {
  std::string kept;
  for (const char c : text)
    if (c != unwanted) kept += c;
  return kept;
}

std::optional<double> number(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  // out of range: overflow is infinite for our purposes, underflow is nothing
  if (code == std::errc::result_out_of_range && end == text.data() + text.size())
    return text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos ? 0.0 : HUGE_VAL;
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Error at(const std::string& file, size_t line, const std::string& what) {
  return Error{file + ":" + std::to_string(line) + ": " + what};
}

Result<PathRow> parseRow(const std::string& file, size_t line_number, std::string_view line, size_t columns) {
  std::array<double, kMostColumns> values{0, 0, 0, 0, 1, 0, 0, 0};
  size_t column = 0;
  for (; column < columns; ++column) {
    const size_t comma = line.find(',');
    const std::optional<double> value = number(line.substr(0, comma));
    if (!value)
      return at(
          file, line_number,
          "column " + std::to_string(column + 1) + ": \"" + std::string(line.substr(0, comma)) + "\" is not a number");
    values[column] = *value;
    if (comma == std::string_view::npos) break;
    line.remove_prefix(comma + 1);
    if (column + 1 == columns) return at(file, line_number, "more than " + std::to_string(columns) + " columns");
  }
  if (column + 1 < columns)
    return at(file, line_number, std::to_string(column + 1) + " columns, expected " + std::to_string(columns));
  PathRow row;
  row.t = values[0];
  row.position = {values[1], values[2], values[3]};
  row.orientation = Eigen::Quaterniond(values[4], values[5], values[6], values[7]);
  return row;
}

}  // namespace

Result<std::vector<PathRow>> readProbePath(const std::string& file) {
  const auto read = readRegular(file, kMaxBytes);
  if (!read) return Error{file + ": " + read.error()};
  const std::string& text = *read;
  std::vector<PathRow> rows;
  size_t columns = 0, line_number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const size_t end = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ++line_number;
    if (line.empty() || line.front() == '#') continue;
    if (columns == 0) {
      const std::string header = without(line, ' ');
      columns = header == kHeader3 ? 4 : header == kHeader6 ? 8 : 0;
      if (columns == 0)
        return at(file, line_number, "header \"" + std::string(line) + "\", expected t,x,y,z or t,x,y,z,qw,qx,qy,qz");
      continue;
    }
    auto row = parseRow(file, line_number, line, columns);
    if (!row) return Error{row.error()};
    if (!std::isfinite(row->t)) return at(file, line_number, "t is not finite");
    if (!rows.empty() && row->t <= rows.back().t)
      return at(file, line_number,
                "t does not grow: " + std::to_string(row->t) + " after " + std::to_string(rows.back().t));
    rows.push_back(*row);
  }
  if (rows.empty()) return Error{file + ": no rows, expected a header t,x,y,z and at least one row"};
  return rows;
}

}  // namespace hapticd::cli
