// SPDX-License-Identifier: MIT
/// Small tools of the readers of mesh files.
#pragma once
#include <Eigen/Core>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hapticd::importing {

/// Splits a text into lines and each line into words, without copies.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  /// Goes to the next line; false at the end. A carriage return ends a line as well, as on old Macs.
  bool nextLine() {
    if (rest_.empty()) return false;
    std::size_t end = rest_.find_first_of("\r\n");
    line_ = whole_ = rest_.substr(0, end);
    if (end != std::string_view::npos && rest_.substr(end, 2) == "\r\n") ++end;
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    return true;
  }
  /// Returns the next word of the line; empty at the end of the line.
  std::string_view next() {
    const std::size_t begin = line_.find_first_not_of(kSpace);
    if (begin == std::string_view::npos) return line_ = {};
    const std::size_t end = std::min(line_.find_first_of(kSpace, begin), line_.size());
    const std::string_view word = line_.substr(begin, end - begin);
    line_.remove_prefix(end);
    return word;
  }
  void skipLine() { line_ = {}; }
  std::string_view restOfLine() const { return line_; }  ///< after the word that was read last
  std::string_view wholeLine() const { return whole_; }
  std::size_t lineNumber() const { return number_; }
  std::string_view rest() const { return rest_; }  ///< the text after this line

 private:
  static constexpr std::string_view kSpace = " \t\v\f";
  std::string_view rest_, line_, whole_;
  std::size_t number_ = 0;
};

/// Returns a word of a file for a message: no more than 40 bytes, and ? for each byte that is no printable ASCII.
inline std::string plainWord(std::string_view word) {
  constexpr std::size_t kMost = 40;
  std::string text(word.substr(0, kMost));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return word.size() > kMost ? text + "..." : text;
}

/// Returns the number if the whole word is a number; nan and inf are numbers too.
inline std::optional<double> anyNumber(std::string_view word) {
  if (!word.empty() && word[0] == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

/// Returns the number if the whole word is a finite number.
inline std::optional<double> finiteNumber(std::string_view word) {
  const auto value = anyNumber(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Returns the next three words as a point, if they are finite numbers.
inline std::optional<Eigen::Vector3d> nextPoint(Words& words) {
  Eigen::Vector3d p;
  for (int k = 0; k < 3; ++k) {
    const auto value = finiteNumber(words.next());
    if (!value) return {};
    p[k] = *value;
  }
  return p;
}

/// Gives equal points the same index, with a hash table (open addressing) of their bits.
class Weld {
 public:
  explicit Weld(std::vector<Eigen::Vector3d>& points) : points_(points), table_(1024, kFree) {}

  std::uint32_t at(const Eigen::Vector3d& given) {
    const Eigen::Vector3d p = given + Eigen::Vector3d::Zero();  // -0 becomes 0
    if (2 * (points_.size() + 1) > table_.size()) grow();
    std::size_t slot = slotOf(p);
    for (; table_[slot] != kFree; slot = (slot + 1) & (table_.size() - 1))
      if (points_[table_[slot]] == p) return table_[slot];
    table_[slot] = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    return table_[slot];
  }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffu;

  std::size_t slotOf(const Eigen::Vector3d& p) const {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(p[k])) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash) & (table_.size() - 1);
  }
  void grow() {
    table_.assign(2 * table_.size(), kFree);
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      std::size_t slot = slotOf(points_[i]);
      while (table_[slot] != kFree) slot = (slot + 1) & (table_.size() - 1);
      table_[slot] = i;
    }
  }

  std::vector<Eigen::Vector3d>& points_;
  std::vector<std::uint32_t> table_;
};

}  // namespace hapticd::importing
