// SPDX-License-Identifier: MIT
#include "cli/device/decoded_table.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

namespace hapticd::cli {
namespace {

/// Returns the fields of one line. A comma between quotes does not separate fields.
std::vector<std::string> fieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted)
      fields.emplace_back();
    else if (c != '\r')
      fields.back() += c;
  }
  return fields;
}

bool isRemark(const std::string& name) {
  static constexpr std::string_view kRemarks[] = {"report", "time", "verdict", "why"};
  return std::find(std::begin(kRemarks), std::end(kRemarks), name) != std::end(kRemarks);
}

}  // namespace

PlainTable plainTable(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> names;
  PlainTable plain;
  for (std::string line; std::getline(in, line); plain.text += '\n') {
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> fields = fieldsOf(line);
    const bool header = names.empty();
    if (header) names = fields;
    if (header && std::find(names.begin(), names.end(), "verdict") == names.end()) return {text, 0};
    std::string kept;
    bool good = true;
    for (size_t i = 0; i < fields.size(); ++i) {
      const bool known = i < names.size();
      if (known && names[i] == "verdict" && !header) good = fields[i] == "good";
      if (!known || !isRemark(names[i])) kept += (kept.empty() ? "" : ",") + fields[i];
    }
    if (good) plain.text += kept;
    plain.left_out += good ? 0 : 1;
  }
  return plain;
}

}  // namespace hapticd::cli
