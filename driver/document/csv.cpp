// SPDX-License-Identifier: MIT
#include "document/csv.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>

#include "base/counted.hpp"
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

/// One field of a line, and the place where it begins.
struct Field {
  std::string_view text;
  size_t offset;
};
std::vector<Field> fieldsOf(std::string_view line, char separator = ',') {
  std::vector<Field> fields;
  for (size_t start = 0; start <= line.size();) {
    const size_t end = std::min(line.find(separator, start), line.size());
    fields.push_back({trimmed(line.substr(start, end - start)), start});
    start = end + 1;
  }
  return fields;
}

/// Returns the name of a column that a name with a unit, capitals or underscores stands for: "x" for "X [mm]", "t" for
/// "time_ms", "qw" for "q_w".
std::string plainName(std::string_view given) {
  std::string name;
  for (const char c : given.substr(0, given.find_first_of("[(/")))
    if (c != ' ') name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const std::string_view unit : {"_ms", "_us", "_s", "_mm", "_cm", "_m"})
    if (name.size() > unit.size() && name.ends_with(unit)) name.resize(name.size() - unit.size());
  std::erase(name, '_');
  return name == "time" ? "t" : name;
}

/// Returns the only column that grows from row to row in a table without a header; the first one if it grows, too, or
/// if there are less than three rows.
size_t growingColumn(std::string_view text) {
  constexpr size_t kEnough = 3;
  std::vector<double> last;
  std::vector<bool> grows;
  size_t rows = 0;
  for (size_t start = 0; start < text.size();) {
    const size_t end = std::min(text.find('\n', start), text.size());
    const std::string_view line = text.substr(start, end - start);
    start = end + 1;
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    const std::vector<Field> fields = fieldsOf(line);
    if (rows == 0 && !numberIn(fields.front().text)) return 0;  // a header
    if (rows == 0) grows.assign(fields.size(), true), last.assign(fields.size(), -HUGE_VAL);
    if (++rows > 0 && fields.size() != grows.size()) continue;
    for (size_t i = 0; i < fields.size(); ++i) {
      const double value = numberIn(fields[i].text).value_or(-HUGE_VAL);
      grows[i] = grows[i] && value > last[i];
      last[i] = value;
    }
    if (grows[0] && rows >= kEnough) return 0;
  }
  const bool one = rows >= kEnough && std::count(grows.begin(), grows.end(), true) == 1;
  return one ? static_cast<size_t>(std::find(grows.begin(), grows.end(), true) - grows.begin()) : 0;
}

class Parser {
 public:
  Parser(const std::string& file, const CsvRules& rules, Problems& problems)
      : file_(file), rules_(rules), problems_(problems) {}

  void line(std::string_view text) {
    ++line_;
    const std::string_view content = trimmed(text);
    if (content.empty() || content.front() == '#') return;
    if (table_.columns == 0 && header(fieldsOf(text), text)) return;
    const std::vector<Field> fields = fieldsOf(text, separator_);
    if (wrong_ == 0 || table_.columns > 0) row(fields);
  }
  /// Names the column that has the times, if the table has no header and its columns are in another
  /// order.
  void putFirst(size_t column) { first_ = column; }
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
  bool header(const std::vector<Field>& fields, std::string_view line) {
    std::string names;  // without quotes, which some programs write around each name
    for (const Field& field : fields) names.append(names.empty() ? "" : ",").append(unquoted(field.text));
    const bool numbers = numberIn(fields.front().text).has_value();
    for (const std::string& header : rules_.headers)
      if (numbers ? fieldsOf(header).size() == fields.size() : header == names) {
        use(header, fields);
        if (numbers) reorder();
        return !numbers;
      }
    const std::string meant = separators(fields, static_cast<size_t>(-1));
    problem(0, "",
            (numbers ? counted(fields.size(), "column") + ", expected " + expected()
                     : "the header is \"" + printable(names.substr(0, 60)) + "\", expected " + expected()) +
                meant);
    if (understood(fields)) return !numbers;
    for (const char other : {';', '\t'}) {
      separator_ = other;
      if (const std::vector<Field> parts = fieldsOf(line, other); parts.size() > 1 && understood(parts))
        return !numberIn(parts.front().text);
    }
    wrong_ = kShownProblems;  // if the columns are unknown, no row can be checked
    return true;
  }

  void use(const std::string& header, const std::vector<Field>& fields) {
    names_ = header;
    table_.columns = fieldsOf(header).size();
    order_.resize(table_.columns);
    std::iota(order_.begin(), order_.end(), size_t{0});
    width_ = fields.size();
  }

  /// Reads the growing column of a table without a header as the first one.
  void reorder() {
    if (first_ == 0 || first_ >= order_.size() || !rules_.growing) return;
    problem(0, "",
            "column " + std::to_string(first_ + 1) + " is the only one that grows from row to row, as " + nameOf(0) +
                " must; expected the order " + names_);
    std::rotate(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(first_),
                order_.begin() + static_cast<std::ptrdiff_t>(first_) + 1);
  }

  /// Finds the columns of a wrong first line by their names, or, if their number is right, by their order, so that the
  /// rows are judged all the same. Returns false if it cannot.
  bool understood(const std::vector<Field>& fields) {
    std::vector<std::string> given;
    for (const Field& field : fields) given.push_back(plainName(unquoted(field.text)));
    std::vector<std::string> widest_first = rules_.headers;
    std::stable_sort(widest_first.begin(), widest_first.end(),
                     [](const std::string& a, const std::string& b) { return a.size() > b.size(); });
    for (const std::string& header : widest_first) {
      std::vector<size_t> order;
      for (const Field& name : fieldsOf(header))
        order.push_back(static_cast<size_t>(std::find(given.begin(), given.end(), name.text) - given.begin()));
      if (*std::max_element(order.begin(), order.end()) == given.size()) continue;  // a name is missing
      use(header, fields);
      order_ = order;
      return true;
    }
    const bool begins = given.front().starts_with(rules_.headers.front().front()) || numberIn(fields[0].text);
    for (const std::string& header : widest_first)
      if (begins && fieldsOf(header).size() == fields.size()) return use(header, fields), true;
    return false;
  }

  std::string nameOf(size_t column) const { return std::string(fieldsOf(names_)[column].text); }

  void row(const std::vector<Field>& fields) {
    if (fields.size() != width_)
      return problem(0, "",
                     counted(fields.size(), "column") + ", expected " + std::to_string(width_) +
                         separators(fields, width_) +
                         (fields.size() > width_ ? "; write decimals with a point: 0.5, not 0,5" : ""));
    const size_t wrong_before = wrong_;
    const bool begun = take(fields[order_[0]], 0);
    for (size_t i = 1; i < table_.columns && !tooWrong(); ++i) take(fields[order_[i]], i);
    if (!begun || tooWrong()) return rejectRow();
    const bool readable = wrong_ == wrong_before;
    const double* now = table_.values.data() + table_.lines.size() * table_.columns;
    if (rules_.growing && last_ && *now <= *last_)
      problem(0, nameOf(0),
              numberText(*now) + " does not grow from row to row, expected more than the " + numberText(*last_) +
                  " of the row before");
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
    std::string text(field.text);
    if (separator_ != ',') std::replace(text.begin(), text.end(), ',', '.');  // reported with the header
    const std::optional<double> value = numberIn(text);
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
  std::string names_;          ///< of the table's columns, separated by commas
  std::vector<size_t> order_;  ///< of each column of the table: its index in the file
  size_t width_ = 0;           ///< columns of the file
  char separator_ = ',';
  size_t first_ = 0;            ///< index in the file of the column that grows
  std::optional<double> last_;  ///< first number of the last row in which it grew
  size_t wrong_ = 0;
  int line_ = 0;
};

}  // namespace

/// Gives the parser all lines of a text, up to the one where too much is wrong.
static void readLines(std::string_view text, Parser& parser) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // spreadsheets write it before UTF-8
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  parser.putFirst(growingColumn(text));
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

std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted(1, '"');
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

}  // namespace hapticd::document
