// SPDX-License-Identifier: MIT
/// The values of a PLY file, one after another: text, or binary of either byte order.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>

#include "mesh_import/mesh_text.hpp"

namespace hapticd::importing::ply {

enum class Type : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble, kUnknown };

inline Type typeOf(std::string_view word) {
  constexpr std::string_view kNames[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                            {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                            {"float", "float32"}, {"double", "float64"}};
  for (std::size_t i = 0; i < std::size(kNames); ++i)
    if (word == kNames[i][0] || word == kNames[i][1]) return static_cast<Type>(i);
  return Type::kUnknown;
}

inline std::size_t sizeOf(Type type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8, 0};
  return kSizes[static_cast<std::size_t>(type)];
}

/// How the values of a text are divided into items.
enum class Lines : std::uint8_t {
  kOneAnItem,  ///< each item has a line of its own; more values than the header states are passed over
  kAnywhere    ///< line breaks do not count
};

/// Reads the values of the body one after another.
class Body {
 public:
  enum class Form : std::uint8_t { kText, kLittle, kBig };
  Body(std::string_view bytes, Form form, Lines lines) : bytes_(bytes), words_(bytes), form_(form), lines_(lines) {}

  /// Goes to the next item. @return false if the file has ended
  bool nextItem() {
    if (form_ == Form::kText && lines_ == Lines::kOneAnItem) word_ = nextWord();
    ended_ = form_ == Form::kText && lines_ == Lines::kOneAnItem && word_.empty();
    return !ended_;
  }

  std::optional<double> next(Type type) {
    if (form_ == Form::kText) {
      if (lines_ == Lines::kAnywhere) word_ = nextWord();
      ended_ = lines_ == Lines::kAnywhere && word_.empty();
      last_ = word_;
      if (lines_ == Lines::kOneAnItem) word_ = words_.next();
      return anyNumber(last_);
    }
    const std::size_t size = sizeOf(type);
    ended_ = bytes_.size() - place_ < size;
    if (ended_) return {};
    std::array<char, 8> raw{};
    for (std::size_t i = 0; i < size; ++i) raw[form_ == Form::kBig ? size - 1 - i : i] = bytes_[place_ + i];
    place_ += size;
    return decode(type, raw);
  }

  /// Passes over the rest of the line if each item has its own line. @return true if it held a value
  bool passRest() {
    const bool more = form_ == Form::kText && lines_ == Lines::kOneAnItem && !word_.empty();
    if (more) words_.skipLine();
    word_ = {};
    return more;
  }
  /// True if nothing but blanks is left of a text.
  bool atEnd() { return form_ != Form::kText || nextWord().empty(); }
  bool isText() const { return form_ == Form::kText; }
  bool ended() const { return ended_; }  ///< true if the last value was missing because the file has ended
  std::string_view lastWord() const { return last_; }  ///< the last value of a text; empty if the line had no more
  std::size_t lineNumber() const { return form_ == Form::kText ? words_.lineNumber() : 0; }

 private:
  /// Returns the next word of this line or a later one.
  std::string_view nextWord() {
    std::string_view word = words_.next();
    while (word.empty() && words_.nextLine()) word = words_.next();
    return word;
  }
  template <class T>
  static double as(const std::array<char, 8>& raw) {
    T value;
    std::memcpy(&value, raw.data(), sizeof value);
    return static_cast<double>(value);
  }
  static std::optional<double> decode(Type type, const std::array<char, 8>& raw) {
    switch (type) {
      case Type::kInt8:
        return as<std::int8_t>(raw);
      case Type::kUint8:
        return as<std::uint8_t>(raw);
      case Type::kInt16:
        return as<std::int16_t>(raw);
      case Type::kUint16:
        return as<std::uint16_t>(raw);
      case Type::kInt32:
        return as<std::int32_t>(raw);
      case Type::kUint32:
        return as<std::uint32_t>(raw);
      case Type::kFloat:
        return as<float>(raw);
      case Type::kDouble:
        return as<double>(raw);
      default:
        return {};
    }
  }

  std::string_view bytes_;
  std::size_t place_ = 0;
  Words words_;
  std::string_view word_, last_;  ///< the word to read next, if each item has its own line; the word read last
  Form form_;
  Lines lines_;
  bool ended_ = false;
};

}  // namespace hapticd::importing::ply
