// SPDX-License-Identifier: MIT
/// A YAML (or JSON) document as plain data. Every node has its line and column, aliases are expanded, and sizes are
/// limited.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "document/problem.hpp"

namespace hapticd::document {

struct Entry;

struct Node {
  enum class Kind : uint8_t { kNull, kScalar, kSequence, kMap };
  Kind kind = Kind::kNull;
  bool quoted = false;  ///< true for a text in quotes: "1" is a text, 1 is a number
  int line = 0, column = 0;
  std::string scalar;
  std::vector<Node> items;     ///< the elements of a list
  std::vector<Entry> entries;  ///< the keys and values of a mapping, in the order of the file

  const Node* find(std::string_view key) const;
  bool isNull() const { return kind == Kind::kNull; }
  bool isScalar() const { return kind == Kind::kScalar; }
  bool isSequence() const { return kind == Kind::kSequence; }
  bool isMap() const { return kind == Kind::kMap; }
};

struct Entry {
  Node key, value;
};

/// Limits for files. A file that exceeds one of them is refused with a message.
constexpr size_t kMaxFileBytes = 32u << 20;  ///< for comparison: a scene of 10,000 models has 2 MB
constexpr int kMaxDepth = 48;
constexpr size_t kMaxNodes = 4'000'000;
/// Largest number of values in a text, with aliases expanded. It stops the attack "billion laughs": a short text whose
/// aliases expand to billions of values. Without aliases, a text has at most two values for each byte.
constexpr size_t maxNodes(size_t bytes) {
  return bytes < kMaxNodes / 4 - 5'000 ? 20'000 + 4 * bytes : kMaxNodes;
}

/// [main] Parses a text. Syntax errors, duplicate keys, cycles and sizes beyond the limits become problems. Returns
/// nothing if the text cannot be read at all.
std::optional<Node> parseText(const std::string& text, const std::string& file, Problems& problems);

/// [main] Reads and parses a file.
std::optional<Node> parseFile(const std::filesystem::path& file, Problems& problems);

/// [main] Parses a text as parseText() does. After a syntax error it reads on with the faulty line corrected or left
/// out, so that the other problems of the file are found too. The result is only for finding problems: a text with a
/// problem is never used otherwise.
std::optional<Node> readOn(const std::string& text, const std::string& file, Problems& problems);

/// [main] Reads a file in the same way.
std::optional<Node> readFileOn(const std::filesystem::path& file, Problems& problems);

/// [main] Reads a file's bytes. Reports a problem if the file is missing, is a folder, is unreadable, or is larger than
/// `max_bytes`.
std::optional<std::string> readFile(const std::filesystem::path& file, size_t max_bytes, Problems& problems);

/// [any] Returns what a node is, for messages, such as "a mapping" or "the text \"abc\"".
std::string describe(const Node& node);

/// [any] Returns the node as JSON. Numbers, true, false and null have no quotes, unless they are quoted in the file.
std::string toJson(const Node& node);

/// [any] Reads a number as YAML writes it (decimal, exponent, .inf, .nan), in any locale. Returns nothing for any other
/// text.
std::optional<double> toNumber(std::string_view text);

}  // namespace hapticd::document
