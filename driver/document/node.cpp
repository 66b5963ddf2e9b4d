// SPDX-License-Identifier: MIT
#include "document/node.hpp"

#include <charconv>
#include <cmath>
#include <unordered_set>

namespace hapticd::document {
namespace {

constexpr size_t kShownText = 40;  ///< longest part of a value that a message shows

void appendJsonText(const std::string& text, std::string& out) {
  static constexpr char kHex[] = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      (out += '\\') += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      (((out += "\\u00") += kHex[c >> 4]) += kHex[c & 15]);
    } else {
      out += c;
    }
  }
  out += '"';
}

/// Returns whether a text is a YAML number that JSON writes in the same way.
bool jsonNumber(const std::string& text) {
  const std::optional<double> value = toNumber(text);
  if (!value || !std::isfinite(*value)) return false;
  const size_t first = text[0] == '-' ? 1 : 0;
  const bool digit_first = text.size() > first && text[first] >= '0' && text[first] <= '9';
  const bool octal_look = text.size() > first + 1 && text[first] == '0' && text[first + 1] != '.' &&
                          text[first + 1] != 'e' && text[first + 1] != 'E';
  const size_t dot = text.find('.');
  const bool bare_dot =
      dot != std::string::npos && (dot + 1 == text.size() || text[dot + 1] < '0' || text[dot + 1] > '9');
  return digit_first && !octal_look && !bare_dot;
}

void appendScalar(const Node& node, std::string& out) {
  if (node.quoted) return appendJsonText(node.scalar, out);
  if (node.scalar == "true" || node.scalar == "false" || jsonNumber(node.scalar)) {
    out += node.scalar;
  } else if (const auto number = toNumber(node.scalar); number && std::isfinite(*number)) {
    char text[32];
    out.append(text, std::to_chars(text, text + sizeof text, *number).ptr);
  } else {
    appendJsonText(node.scalar, out);
  }
}

void appendJson(const Node& node, std::string& out) {
  std::unordered_set<std::string_view> first;
  switch (node.kind) {
    case Node::Kind::kNull:
      out += "null";
      return;
    case Node::Kind::kScalar:
      appendScalar(node, out);
      return;
    case Node::Kind::kSequence:
      out += '[';
      for (size_t i = 0; i < node.items.size(); ++i) {
        if (i > 0) out += ',';
        appendJson(node.items[i], out);
      }
      out += ']';
      return;
    case Node::Kind::kMap:
      out += '{';  // of a key that is given twice, the first counts, as for find()
      for (size_t i = 0; i < node.entries.size(); ++i) {
        if (!first.insert(node.entries[i].key.scalar).second) continue;
        if (i > 0) out += ',';
        appendJsonText(node.entries[i].key.scalar, out);
        out += ':';
        appendJson(node.entries[i].value, out);
      }
      out += '}';
      return;
  }
}

}  // namespace

const Node* Node::find(std::string_view key) const {
  for (const Entry& entry : entries)
    if (entry.key.scalar == key) return &entry.value;
  return nullptr;
}

std::string describe(const Node& node) {
  if (node.isNull()) return "nothing";
  if (node.isMap()) return "a mapping";
  if (node.isSequence()) return "a list";
  const std::string shown =
      node.scalar.size() <= kShownText ? node.scalar : node.scalar.substr(0, kShownText - 3) + "...";
  if (!node.quoted && toNumber(node.scalar)) return shown;
  return "the text \"" + shown + "\"";
}

std::string toJson(const Node& node) {
  std::string out;
  appendJson(node, out);
  return out;
}

std::optional<double> toNumber(std::string_view text) {
  bool negative = false;
  if (!text.empty() && (text[0] == '+' || text[0] == '-')) {
    negative = text[0] == '-';
    text.remove_prefix(1);
  }
  if (text == ".nan" || text == ".NaN" || text == ".NAN") return std::nan("");
  if (text == ".inf" || text == ".Inf" || text == ".INF") return negative ? -INFINITY : INFINITY;
  if (text.empty() || !((text[0] >= '0' && text[0] <= '9') || text[0] == '.')) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range)  // A number that is too small becomes zero. One that is too large
                                                // becomes infinite, and is refused for that.
    value = text.find("e-") != text.npos || text.find("E-") != text.npos ? 0 : INFINITY;
  else if (error != std::errc())
    return std::nullopt;
  return negative ? -value : value;
}

}  // namespace hapticd::document
