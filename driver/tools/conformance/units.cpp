// SPDX-License-Identifier: MIT
/// Tests the units of parameters. A scene is in SI units throughout, so a person reads a number in mm among metres as
/// metres. The host reads some units as well: it knows a damper by "N s/m".
#include <cctype>
#include <optional>
#include <string_view>

#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

struct Foreign {
  std::string_view unit, si;
};

/// Units that authors write, and the SI unit for each.
constexpr Foreign kForeign[] = {
    {"mm", "m"},       {"cm", "m"},          {"um", "m"},     {"nm", "m"},     {"km", "m"},          {"in", "m"},
    {"inch", "m"},     {"g", "kg"},          {"mg", "kg"},    {"t", "kg"},     {"ms", "s"},          {"us", "s"},
    {"ns", "s"},       {"min", "s"},         {"h", "s"},      {"kHz", "Hz"},   {"MHz", "Hz"},        {"rpm", "rad/s"},
    {"mN", "N"},       {"kN", "N"},          {"kgf", "N"},    {"deg", "rad"},  {"degree", "rad"},    {"degrees", "rad"},
    {"\u00b0", "rad"}, {"kPa", "Pa"},        {"MPa", "Pa"},   {"GPa", "Pa"},   {"bar", "Pa"},        {"psi", "Pa"},
    {"Newton", "N"},   {"newton", "N"},      {"sec", "s"},    {"Kg", "kg"},    {"hz", "Hz"},         {"radians", "rad"},
    {"Nmm", "N m"},    {"Ncm", "N m"},       {"meters", "m"}, {"metres", "m"}, {"lbf", "N"},         {"meter", "m"},
    {"metre", "m"},    {"rad/sec", "rad/s"}, {"mV", "V"},     {"mA", "A"},     {"%", "a part of 1"}, {"mJ", "J"},
    {"mW", "W"},
};

/// Returns the first part of a unit that is known not to be SI, such as "mm" in "N/mm"; nullptr if there is none.
const Foreign* foreignPart(std::string_view unit) {
  const auto letter = [](unsigned char c) { return std::isalpha(c) != 0 || c == '%' || c >= 0x80; };
  for (size_t i = 0; i < unit.size();) {
    size_t end = i;
    while (end < unit.size() && letter(unit[end])) ++end;
    for (const Foreign& foreign : kForeign)
      if (unit.substr(i, end - i) == foreign.unit) return &foreign;
    i = end + 1;
  }
  return nullptr;
}

/// Symbols of SI units that parameters have, the longer ones first.
constexpr std::string_view kSymbols[] = {"rad", "Hz", "kg", "Pa", "m", "s", "N", "J", "W", "V", "A", "K", "C"};

/// Returns symbols that are written together with blanks between them, such as "N s" for "Ns", or nothing if there is
/// another word in the text. A single symbol is returned as it is.
std::optional<std::string> apart(std::string_view word) {
  if (word.empty()) return "";
  for (const std::string_view symbol : kSymbols) {
    if (!word.starts_with(symbol)) continue;
    const auto rest = apart(word.substr(symbol.size()));
    if (rest) return std::string(symbol) + (rest->empty() ? "" : " ") + *rest;
  }
  return {};
}

/// Returns how scenes write a unit of SI symbols that is written in another way, such as "N s/m" for "Ns/m", "N*s/m" or
/// "N.s/m"; "" if it is written well, or holds words that are not known here.
std::string asInScenes(std::string_view unit) {
  std::string well;
  for (size_t i = 0; i < unit.size();) {
    size_t end = i;
    while (end < unit.size() && std::isalpha(static_cast<unsigned char>(unit[end])) != 0) ++end;
    if (end > i) {
      const auto symbols = apart(unit.substr(i, end - i));
      if (!symbols) return "";
      well += *symbols;
    } else {
      const bool dot = unit.substr(i).starts_with("·");
      const bool times = (dot || unit[i] == '*' || unit[i] == '.') && i > 0 &&
                         std::isalpha(static_cast<unsigned char>(unit[i - 1])) != 0 && i + 1 < unit.size();
      well += times ? ' ' : unit[i];
      end = i + (dot ? 2 : 1);
    }
    i = end;
  }
  return well == unit ? "" : well;
}

}  // namespace

Verdict unitsSi(const Recipe& recipe, uint64_t) {
  const auto objection = [](const hsp_param& p) -> std::string {
    if (p.unit == nullptr) return "";
    const std::string told = std::string(p.id) + ": the unit is \"" + p.unit + "\", expected ";
    if (const Foreign* foreign = foreignPart(p.unit))
      return told + std::string(foreign->si) + " for " + std::string(foreign->unit);
    const std::string well = asInScenes(p.unit);
    return well.empty() ? "" : told + "\"" + well + "\"";
  };
  return warningOfParams(recipe, objection, "; ", ": scenes are in SI units throughout");
}

}  // namespace hapticd::conformance
