// SPDX-License-Identifier: MIT
/// A view of structured data that knows the path of every key, so that what is wrong in a device file can be named.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

namespace hapticd::codec {

/// One value and where it stands. A problem is noted with its path, and reading goes on with an allowed value, so that
/// all problems of a file are reported at once.
class Tree {
 public:
  bool has(const char* key) const;
  Tree at(const char* key) const;  ///< a key that must exist; if it is missing, an allowed value is read from there
  Tree item(size_t index) const;
  size_t count() const;  ///< of a list
  /// A number, or text such as 0x1A. @param unit for messages; "": it has none
  double number(double least, double most, const char* unit = "") const;
  double whole(double least, double most) const;
  uint64_t bits(unsigned width) const;  ///< a whole number of up to 64 bits, exactly; negative: two's complement
  bool boolean() const;
  std::string text() const;
  bool only(std::span<const char* const> keys) const;  ///< a mapping with no other keys
  void fail(const std::string& what) const;            ///< notes "path: what"
  bool exists() const { return value_ != nullptr; }
  size_t problems() const;  ///< problems of the whole document so far

 private:
  friend class Document;
  Tree(const void* value, std::string path, void* data) : value_(value), path_(std::move(path)), data_(data) {}
  bool isMapping() const;
  const void* value_;  // nullptr: it is missing, which has been noted
  std::string path_;
  void* data_;
};

/// Owns what a Tree looks at.
class Document {
 public:
  /// @param name what messages call the document
  Document(const std::string& json, std::string name);
  ~Document();
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;
  Tree root() const;
  /// Throws std::invalid_argument with all problems that were noted, one per line.
  void check() const;

 private:
  struct Data;
  friend class Tree;
  std::unique_ptr<Data> data_;
};

}  // namespace hapticd::codec
