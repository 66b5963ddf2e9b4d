// SPDX-License-Identifier: MIT
#include "document/correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/short_number.hpp"
#include "document/reader.hpp"
#include "document/suggestion.hpp"

namespace hapticd::document {
namespace {

constexpr size_t kLongest = 60;  ///< longest text that is examined; a longer one is not a number with a unit

/// A unit as people write it, the unit that hapticd uses, and the factor between them.
struct KnownUnit {
  const char *written, *unit;
  double size;
};
constexpr std::array kUnits{
    KnownUnit{"mm", "m", 1e-3},        KnownUnit{"cm", "m", 1e-2},          KnownUnit{"um", "m", 1e-6},
    KnownUnit{"µm", "m", 1e-6},        KnownUnit{"in", "m", 0.0254},        KnownUnit{"kHz", "Hz", 1e3},
    KnownUnit{"khz", "Hz", 1e3},       KnownUnit{"ms", "s", 1e-3},          KnownUnit{"us", "s", 1e-6},
    KnownUnit{"min", "s", 60},         KnownUnit{"deg", "rad", M_PI / 180}, KnownUnit{"degrees", "rad", M_PI / 180},
    KnownUnit{"°", "rad", M_PI / 180}, KnownUnit{"g", "kg", 1e-3},          KnownUnit{"mN", "N", 1e-3},
    KnownUnit{"kN", "N", 1e3},         KnownUnit{"N/mm", "N/m", 1e3},       KnownUnit{"kN/m", "N/m", 1e3},
    KnownUnit{"N/cm", "N/m", 100},     KnownUnit{"mNm", "N m", 1e-3},       KnownUnit{"Nmm", "N m", 1e-3},
    KnownUnit{"mm/s", "m/s", 1e-3},    KnownUnit{"cm/s", "m/s", 1e-2},      KnownUnit{"ms", "us", 1e3},
    KnownUnit{"s", "us", 1e6},         KnownUnit{"Ns/mm", "N s/m", 1e3}};

std::string replaced(std::string_view text, std::string_view what, std::string_view with) {
  std::string out;
  for (size_t at = 0; at < text.size();) {
    const bool here = text.substr(at, what.size()) == what;
    out += here ? with : text.substr(at, 1);
    at += here ? what.size() : 1;
  }
  return out;
}

/// Returns the product of a number and a unit in the form in which a person would write it, without rounding errors in
/// its last digits.
std::string rounded(double value) {
  constexpr int kDigits = 7;
  return shortNumber(value, kDigits);
}

std::string_view withoutBlanks(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns the unit without blanks, points and asterisks, so that "Ns/m", "N*s/m" and "N s/m" become the same text.
std::string squeezed(std::string_view unit) {
  std::string out;
  for (const char c : replaced(unit, "·", "")) out += c == ' ' || c == '*' || c == '.' ? "" : std::string(1, c);
  return out;
}

/// Returns the length of the longest number at the beginning of the text; 0 if there is none.
size_t numberLength(std::string_view text) {
  for (size_t length = text.size(); length > 0; --length)
    if (toNumber(text.substr(0, length))) return length;
  return 0;
}

/// Returns the number without separators between its thousands, as in 1'000; nothing if it has no such separators.
std::optional<std::string> ungrouped(std::string_view text) {
  std::string out;
  size_t group = 0;  // digits since the last separator
  bool grouped = false;
  for (const char c : text) {
    if (c == '\'' || c == '_' || c == ' ') {
      if (group == 0 || group > 3 || (grouped && group != 3)) return std::nullopt;
      grouped = true;
      group = 0;
      continue;
    }
    group += isDigit(c) ? 1 : 0;
    out += c;
  }
  return grouped && group == 3 && toNumber(out) ? std::optional(out) : std::nullopt;
}

/// Returns advice for a number that is followed by the text `rest`: what its writer probably meant, and how to write
/// that.
std::string suggestUnit(double number, const std::string& shown, std::string_view rest, std::string_view unit) {
  const std::string value = numberText(number), behind(rest);
  if (rest == "," || rest == ";") return "; write " + value + ", without the " + behind + " after it";
  if (rest == "%") return "; write " + rounded(number / 100) + ": percentages are not accepted";
  if (rest.substr(0, 2) == "//") return "; begin a comment with a blank and #";
  if (rest.find_first_of("*^+(") == 0 || rest.substr(0, 2) == "pi" || (rest[0] == '/' && rest.size() > 1))
    return "; write the result as a number: formulas are not calculated";
  if (isDigit(rest[0]) || rest[0] == '.' || rest[0] == '-') return "";
  if (!unit.empty() && squeezed(rest) == squeezed(unit)) return "; write " + value + ", without the unit";
  for (const KnownUnit& known : kUnits)
    if (squeezed(rest) == known.written && unit == known.unit)
      return "; write " + rounded(number * known.size) + ": " + shown + " is " + rounded(number * known.size) + " " +
             std::string(unit);
  return unit.empty() ? "; write the number alone, in SI units" : "; write the number alone, in " + std::string(unit);
}

std::string bare(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '(' || c == ')' || c == '[' || c == ']' || c == ',' || c == ';' ? ' ' : c;
  return out;
}

/// Returns the other unit of length in which people write small numbers: ", and 20 cm is 0.2 m"; "" if that is no
/// likely one. @param meant the unit that is suggested first
std::string centimetres(double value, std::string_view meant) {
  constexpr double kLeast = 1, kMost = 100;  // larger numbers are millimetres
  if (meant != "mm" || std::abs(value) < kLeast || std::abs(value) >= kMost) return "";
  return ", and " + numberText(value) + " cm is " + rounded(value / 100) + " m";
}

}  // namespace

std::string suggestNumber(std::string_view given, std::string_view unit) {
  const std::string_view text = withoutBlanks(given);
  if (text.empty() || text.size() > kLongest) return "";
  if (const std::optional<double> number = toNumber(text))
    return std::isfinite(*number) ? "; write " + std::string(text) + ", without quotes or a tag"
                                  : "; it must be finite";
  if (const std::string minus = replaced(replaced(text, "−", "-"), "–", "-"); minus != text && toNumber(minus))
    return "; write " + minus + ", with the minus sign of the keyboard";
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) return "; write it as a decimal number";
  if (const auto plain = ungrouped(text)) return "; write " + *plain + ", with nothing between the digits";
  const size_t comma = text.find(',');
  const bool decimal = comma != text.npos && comma > 0 && isDigit(text[comma - 1]) && comma + 1 < text.size() &&
                       isDigit(text[comma + 1]);
  std::string point(text);
  if (decimal) point[comma] = '.';
  const size_t length = numberLength(point);
  const std::string_view rest = withoutBlanks(std::string_view(point).substr(length));
  if (length == 0 || (decimal && length <= comma + 1)) return "";
  const std::string number = point.substr(0, length);
  if (decimal && rest.empty() && point.size() == comma + 4)  // 1,000 may mean one thousand, or one with three decimals
    return "; write " + point.substr(0, comma) + point.substr(comma + 1) + ", or " + number + " with a point";
  if (decimal && rest.empty()) return "; write " + number + ", with a point, not a comma";
  if (decimal && rest.find(',') != rest.npos) return "";
  return (decimal ? "; write decimals with a point" : "") +
         suggestUnit(toNumber(number).value_or(0), number + " " + std::string(rest), rest, unit);
}

std::string wrongDecimal(const std::string& text) {
  const std::string advice = toNumber(text) ? "" : suggestNumber(text);
  return advice.empty() ? "" : "\"" + text + "\" is not a number" + advice;
}

OtherUnit suggestOtherUnit(double value, std::pair<double, double> allowed, std::string_view unit) {
  struct UnitSlip {
    const char *unit, *meant;
    double factor;
    double least;  ///< smallest number that people write in this unit
  };
  static constexpr UnitSlip kSlips[] = {{"m", "mm", 1e-3, 0.1},     {"rad", "degrees", M_PI / 180, 0.1},
                                        {"s", "ms", 1e-3, 0.02},    {"s", "us", 1e-6, 1},
                                        {"kg", "g", 1e-3, 0.1},     {"N", "mN", 1e-3, 1},
                                        {"N m", "N mm", 1e-3, 0.1}, {"Hz", "kHz", 1e3, 0.1}};
  for (const UnitSlip& slip : kSlips)
    if (const double meant = value * slip.factor;
        unit == slip.unit && std::abs(value) >= slip.least && meant >= allowed.first && meant <= allowed.second)
      return {"; " + numberText(value) + " " + slip.meant + " is " + rounded(meant) + " " + slip.unit +
                  centimetres(value, slip.meant),
              meant};
  return {};
}

std::string suggestDecimals(const Node& list, size_t least) {
  size_t commas = 0;
  std::string first;
  const auto isWhole = [](const Node& item) {
    return item.isScalar() && !item.scalar.empty() && std::all_of(item.scalar.begin(), item.scalar.end(), isDigit);
  };
  for (size_t i = 0; i + 1 < list.items.size(); ++i) {
    if (list.items[i].scalar != "0" || !isWhole(list.items[i + 1]) || toNumber(list.items[i + 1].scalar) == 0) continue;
    if (first.empty()) first = list.items[i + 1].scalar;
    ++commas, ++i;
  }
  if (commas < least || first.empty()) return "";
  return "; a comma separates two numbers: write 0." + first + ", not 0," + first;
}

std::string suggestList(const Node& node, size_t count) {
  if (node.isMap()) return "; write the numbers alone, as [x, y, z]";
  if (node.isSequence() && node.items.size() > count) {
    for (const Node& item : node.items)
      if (!item.isScalar() || !toNumber(item.scalar)) return "";
    return "; a comma separates two numbers: write decimals with a point, such as 0.5";
  }
  if (!node.isScalar()) return "";
  if (!node.scalar.empty() && node.scalar[0] == '(') return "; write it in brackets, as [0, 0, 0.1]";
  std::vector<std::string> numbers;
  const std::string text = bare(node.scalar.substr(0, kLongest));
  for (size_t at = text.find_first_not_of(' '); at != text.npos; at = text.find_first_not_of(' ', at)) {
    const size_t end = std::min(text.find(' ', at), text.size());
    if (!toNumber(text.substr(at, end - at))) return "";
    numbers.push_back(text.substr(at, end - at));
    at = end;
  }
  return numbers.size() == count ? "; write [" + listed(numbers) + "]" : "";
}

std::string suggestMapping(const Node& node) {
  const bool dashes = node.isSequence() && !node.items.empty() &&
                      std::all_of(node.items.begin(), node.items.end(), [](const Node& item) { return item.isMap(); });
  if (dashes) return "; leave out \"- \" before its keys";
  if (!node.isScalar() || node.quoted || node.scalar.size() > kLongest) return "";
  const size_t sign = node.scalar.find_first_of(":=");
  if (sign == std::string::npos || sign == 0 || sign + 1 >= node.scalar.size()) return "";
  const std::string key(withoutBlanks(std::string_view(node.scalar).substr(0, sign)));
  const std::string value(withoutBlanks(std::string_view(node.scalar).substr(sign + 1)));
  if (key.find_first_of(" /") != key.npos || value.empty() || value[0] == '/') return "";
  return "; write " + key + ": " + value + ", with a colon and a blank";
}

std::string suggestKey(std::string_view key) {
  const bool digits = !key.empty() && std::all_of(key.begin(), key.end(), isDigit);
  if (digits || toNumber(key))
    return " (there is a comma before it: write decimals with a point, such as 0." +
           (digits ? std::string(key.substr(0, kLongest)) : "5") + ")";
  const size_t colon = key.find(':');
  if (colon != key.npos && colon > 0 && colon + 1 < key.size())
    return " (no blank after the colon, expected \"" + std::string(key.substr(0, colon)) + ": " +
           std::string(key.substr(colon + 1, kLongest)) + "\")";
  if (key.find("\u00a0") != key.npos) return " (it contains a no-break space, expected ordinary blanks)";
  if (key.find("\u201c") != key.npos || key.find("\u201d") != key.npos || key.find("\u2018") != key.npos ||
      key.find("\u2019") != key.npos)
    return " (it has typographic quotes around it, expected \" or no quotes)";
  return "";
}

std::string suggestPath(std::string_view path) {
  const char first = path.empty() ? ' ' : path[0];
  if (first == '~' || first == '$')
    return std::string("; ") + first + " is not replaced here: write the folder's whole path";
  if (path.find('\\') != path.npos) return "; folders are separated by /";
  return "";
}

}  // namespace hapticd::document
