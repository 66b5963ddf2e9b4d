// SPDX-License-Identifier: MIT
#include "document/csv.hpp"

#include <algorithm>

#include "document/correction.hpp"
#include "document/node.hpp"
#include "document/reader.hpp"

namespace hapticd::document {
namespace {

/// Largest number of problems that are reported for one file. A file in another format is wrong in every line.
constexpr size_t kShownProblems = 20;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Reads a number as YAML writes it, or nan and inf as printf writes them.
std::optional<double> numberIn(std::string_view text) {
  if (text == "nan" || text == "-nan") return std::nan("");
  if (text == "inf" || text == "-inf") return text.front() == '-' ? -HUGE_VAL : HUGE_VAL;
  return toNumber(text);
}

/// Returns the text without the quotes around it.
std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() > 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// Returns the text for a terminal, without bytes of another encoding that would confuse it.
std::string printable(std::string text) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

std::string countText(size_t columns) {
  return std::to_string(columns) + (columns == 1 ? " column" : " columns");
}

/// One field of a line, and the place where it begins.
struct Field {
  std::string_view text;
  size_t offset;
};
std::vector<Field> fieldsOf(std::string_view line) {
  std::vector<Field> fields;
  for (size_t start = 0; start <= line.size();) {
    const size_t comma = std::min(line.find(',', start), line.size());
    fields.push_back({trimmed(line.substr(start, comma - start)), start});
    start = comma + 1;
  }
  return fields;
}

class Parser {
 public:
  Parser(const std::string& file, const CsvRules& rules, Problems& problems)
      : file_(file), rules_(rules), problems_(problems) {}

  void line(std::string_view text) {
    ++line_;
    const std::string_view content = trimmed(text);
    if (content.empty() || content.front() == '#') return;
    const std::vector<Field> fields = fieldsOf(text);
    if (table_.columns == 0 && header(fields)) return;
    if (wrong_ == 0 || table_.columns > 0) row(fields);
  }
  bool tooWrong() const { return wrong_ >= kShownProblems; }
  CsvTable takeSound() { return std::move(table_); }

  std::optional<CsvTable> take() {
    line_ = std::max(line_, 1);
    if (wrong_ == 0 && table_.lines.empty())
      problem(0, "", "there are no rows, expected a header " + expected() + " and at least one row");
    return wrong_ == 0 ? std::optional(std::move(table_)) : std::nullopt;
  }

 private:
  std::string expected() const {
    std::string text;
    for (const std::string& header : rules_.headers) text += (text.empty() ? "" : " or ") + header;
    return text;
  }
  /// Returns a hint if the columns of the line seem to be separated by other characters than commas; else "".
  static std::string separators(const std::vector<Field>& fields, size_t columns) {
    if (fields.size() >= columns) return "";
    bool others = fields.size() == 1 && fields[0].text.find(' ') != std::string_view::npos;
    for (const Field& field : fields) others = others || field.text.find_first_of(";\t") != std::string_view::npos;
    if (others) return "; separate columns by commas, and write decimals with a point";
    return "";
  }
  void problem(size_t offset, const std::string& column, const std::string& what) {
    if (wrong_++ >= kShownProblems) return;
    report(problems_, file_, line_, static_cast<int>(offset) + 1, column, what);
  }

  /// Chooses the columns by the first line. Returns true if this line was a header.
  bool header(const std::vector<Field>& fields) {
    std::string names;  // without quotes, which some programs write around each name
    for (const Field& field : fields) names.append(names.empty() ? "" : ",").append(unquoted(field.text));
    const bool numbers = numberIn(fields.front().text).has_value();
    for (const std::string& header : rules_.headers) {
      const auto columns = static_cast<size_t>(std::count(header.begin(), header.end(), ',')) + 1;
      if (numbers ? columns != fields.size() : header != names) continue;
      names_ = header;
      table_.columns = columns;
      return !numbers;
    }
    const std::string meant = separators(fields, static_cast<size_t>(-1));
    problem(0, "",
            (numbers ? countText(fields.size()) + ", expected " + expected()
                     : "the header is \"" + printable(names.substr(0, 60)) + "\", expected " + expected()) +
                meant);
    wrong_ = kShownProblems;  // if the columns are unknown, no row can be checked
    return true;
  }

  std::string nameOf(size_t column) const { return std::string(fieldsOf(names_)[column].text); }

  void row(const std::vector<Field>& fields) {
    if (fields.size() != table_.columns)
      return problem(0, "",
                     countText(fields.size()) + ", expected " + std::to_string(table_.columns) +
                         separators(fields, table_.columns) +
                         (fields.size() > table_.columns ? "; write decimals with a point: 0.5, not 0,5" : ""));
    const size_t wrong_before = wrong_;
    const bool begun = take(fields[0], 0);
    for (size_t i = 1; i < fields.size() && !tooWrong(); ++i) take(fields[i], i);
    if (!begun || tooWrong()) return rejectRow();
    const bool readable = wrong_ == wrong_before;
    const double* now = table_.values.data() + table_.lines.size() * table_.columns;
    if (rules_.growing && last_ && *now <= *last_)
      problem(0, nameOf(0),
              numberText(*now) + " does not grow from row to row, expected more than " + numberText(*last_));
    else
      last_ = *now;
    if (rules_.wrongIn != nullptr && readable)
      if (const std::string what = rules_.wrongIn(now, table_.columns); !what.empty())
        problem(0, rules_.column_of_wrong, what);
    if (wrong_ != wrong_before) return rejectRow();
    table_.lines.push_back(line_);
  }

  void rejectRow() { table_.values.resize(table_.lines.size() * table_.columns); }

  /// Adds the number to the table, or notes why it is none.
  bool take(const Field& field, size_t column) {
    const std::optional<double> value = numberIn(field.text);
    const bool finite = rules_.finite || (rules_.growing && column == 0);
    const bool good = value && (finite ? std::isfinite(*value) && std::abs(*value) <= rules_.largest : true);
    if (!good)
      problem(field.offset, nameOf(column),
              "\"" + std::string(field.text.substr(0, 40)) + "\" is not valid, expected a " +
                  (finite ? "finite number" : "number") +
                  (value ? (std::isfinite(*value) ? " of at most " + numberText(rules_.largest) : "")
                         : suggestNumber(unquoted(field.text))));
    else
      table_.values.push_back(*value);
    return good;
  }

  const std::string& file_;
  const CsvRules& rules_;
  Problems& problems_;
  CsvTable table_;
  std::string names_;
  std::optional<double> last_;  ///< first number of the last row in which it grew
  size_t wrong_ = 0;
  int line_ = 0;
};

}  // namespace

/// Gives the parser all lines of a text, up to the one where too much is wrong.
static void readLines(std::string_view text, Parser& parser) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // spreadsheets write it before UTF-8
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  for (size_t start = 0; start < text.size() && !parser.tooWrong();) {
    const size_t end = std::min(text.find('\n', start), text.size());
    parser.line(text.substr(start, end - start));
    start = end + 1;
  }
}

std::optional<CsvTable> parseCsv(std::string_view text, const std::string& file, const CsvRules& rules,
                                 Problems& problems) {
  Parser parser(file, rules, problems);
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    report(problems, file, 1, 1, "", "the file is in UTF-16, expected UTF-8: save it as CSV UTF-8");
    return std::nullopt;
  }
  readLines(text, parser);
  return parser.take();
}

std::optional<CsvTable> readSoundRows(const std::filesystem::path& file, size_t max_bytes, const CsvRules& rules) {
  Problems unread;
  const auto text = readFile(file, max_bytes, unread);
  if (!text) return std::nullopt;
  const std::string name = file.string();
  Parser parser(name, rules, unread);
  readLines(*text, parser);
  CsvTable table = parser.takeSound();
  return table.columns == 0 ? std::nullopt : std::optional(std::move(table));
}

std::optional<CsvTable> readCsv(const std::filesystem::path& file, size_t max_bytes, const CsvRules& rules,
                                Problems& problems) {
  const auto text = readFile(file, max_bytes, problems);
  return text ? parseCsv(*text, file.string(), rules, problems) : std::nullopt;
}

}  // namespace hapticd::document
