// SPDX-License-Identifier: MIT
/// A view of structured data that knows the path of every key, so that what is wrong in a device file can be named.
#pragma once
#include <initializer_list>
#include <memory>
#include <string>

namespace hapticd::codec {

/// One value and where it stands. Every function throws std::invalid_argument with the path for a wrong value.
class Tree {
 public:
  bool has(const char* key) const;
  Tree at(const char* key) const;  ///< a key that must be there
  Tree item(size_t index) const;
  size_t count() const;                            ///< of a list
  double number(double least, double most) const;  ///< a number, or text such as 0x1A
  double whole(double least, double most) const;
  bool boolean() const;
  std::string text() const;
  void only(std::initializer_list<const char*> keys) const;  ///< a mapping with no other keys
  [[noreturn]] void fail(const std::string& what) const;     ///< "path: what"

 private:
  friend class Document;
  Tree(const void* value, std::string path) : value_(value), path_(std::move(path)) {}
  const void* value_;
  std::string path_;
};

/// Owns what a Tree looks at.
class Document {
 public:
  /// @param name what messages call the whole
  Document(const std::string& json, std::string name);
  ~Document();
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;
  Tree root() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace hapticd::codec
