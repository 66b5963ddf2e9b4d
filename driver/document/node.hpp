// SPDX-License-Identifier: MIT
/// A YAML (or JSON) document as plain data: every node knows its place, aliases are expanded, sizes are bounded.
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
  bool quoted = false;  ///< "1" is a text, 1 a number
  int line = 0, column = 0;
  std::string scalar;
  std::vector<Node> items;     ///< of a sequence
  std::vector<Entry> entries;  ///< keys of a map, in the order of the file; names may repeat

  const Node* find(std::string_view key) const;
  bool isNull() const { return kind == Kind::kNull; }
  bool isScalar() const { return kind == Kind::kScalar; }
  bool isSequence() const { return kind == Kind::kSequence; }
  bool isMap() const { return kind == Kind::kMap; }
};

struct Entry {
  Node key, value;
};

/// Bounds of what is read. A file beyond them is refused with a message.
constexpr size_t kMaxFileBytes = 32u << 20;  ///< a scene of 10,000 models is 2 MB
constexpr int kMaxDepth = 48;
constexpr size_t kMaxNodes = 4'000'000;
/// Values of a short text, aliases included: this stops "a billion laughs". Without aliases a byte gives two at most.
constexpr size_t maxNodes(size_t bytes) {
  return bytes < kMaxNodes / 4 - 5'000 ? 20'000 + 4 * bytes : kMaxNodes;
}

/// [main] Parses a text. Syntax errors, duplicate keys, cycles and sizes beyond the bounds become problems; nothing is
/// returned when the text cannot be read at all.
std::optional<Node> parseText(const std::string& text, const std::string& file, Problems& problems);

/// [main] Reads and parses a file.
std::optional<Node> parseFile(const std::filesystem::path& file, Problems& problems);

/// [main] Reads a file's bytes, or reports a problem: it is missing, a folder, unreadable, or larger than `max_bytes`.
std::optional<std::string> readFile(const std::filesystem::path& file, size_t max_bytes, Problems& problems);

/// [any] What a node is, for messages: "a mapping", "the text \"abc\"".
std::string describe(const Node& node);

/// [any] The node as JSON text: numbers, true, false and null as such, unless quoted.
std::string toJson(const Node& node);

/// [any] A number as YAML writes it (decimal, exponent, .inf, .nan); nothing for anything else. Locale does not matter.
std::optional<double> toNumber(std::string_view text);

}  // namespace hapticd::document
