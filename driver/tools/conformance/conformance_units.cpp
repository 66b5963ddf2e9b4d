// SPDX-License-Identifier: MIT
/// Tests the units of parameters. A scene is in SI units throughout, so a person reads a number in mm among metres as
/// metres.
#include <cctype>
#include <string_view>

#include "conformance/conformance_parts.hpp"

namespace hapticd::conformance {
namespace {

struct Foreign {
  std::string_view unit, si;
};

/// Units that authors write, and the SI unit for each.
constexpr Foreign kForeign[] = {
    {"mm", "m"},       {"cm", "m"},          {"um", "m"},    {"nm", "m"},    {"km", "m"},          {"in", "m"},
    {"inch", "m"},     {"g", "kg"},          {"mg", "kg"},   {"t", "kg"},    {"ms", "s"},          {"us", "s"},
    {"ns", "s"},       {"min", "s"},         {"h", "s"},     {"kHz", "Hz"},  {"MHz", "Hz"},        {"rpm", "rad/s"},
    {"mN", "N"},       {"kN", "N"},          {"kgf", "N"},   {"deg", "rad"}, {"degree", "rad"},    {"degrees", "rad"},
    {"\u00b0", "rad"}, {"kPa", "Pa"},        {"MPa", "Pa"},  {"GPa", "Pa"},  {"bar", "Pa"},        {"psi", "Pa"},
    {"Newton", "N"},   {"lbf", "N"},         {"meter", "m"}, {"metre", "m"}, {"rad/sec", "rad/s"}, {"mV", "V"},
    {"mA", "A"},       {"%", "a part of 1"}, {"mJ", "J"},    {"mW", "W"},
};

/// Returns the first part of a unit that is known not to be SI, such as "mm" in "N/mm"; nullptr if there is none.
const Foreign* foreignPart(std::string_view unit) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '%' || c < 0; };
  for (size_t i = 0; i < unit.size();) {
    size_t end = i;
    while (end < unit.size() && letter(unit[end])) ++end;
    for (const Foreign& foreign : kForeign)
      if (unit.substr(i, end - i) == foreign.unit) return &foreign;
    i = end + 1;
  }
  return nullptr;
}

}  // namespace

std::string unitsSi(const Recipe& recipe, uint64_t) {
  const auto objection = [](const hsp_param& p) -> std::string {
    const Foreign* foreign = p.unit != nullptr ? foreignPart(p.unit) : nullptr;
    if (foreign == nullptr) return "";
    return std::string(p.id) + ": the unit is \"" + p.unit + "\", expected " + std::string(foreign->si) + " for " +
           std::string(foreign->unit);
  };
  return warningOfParams(recipe, objection, "; ", ": scenes are in SI units throughout");
}

}  // namespace hapticd::conformance
