// SPDX-License-Identifier: MIT
/// A view of structured data. Each value has the path of its key, so that an error message can name the key in the
/// device file.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace hapticd::codec {

/// One value and its path. If the value is wrong, a problem is noted with the path, and an allowed value is returned
/// instead. So reading continues, and all problems of a file are reported at once.
class Tree {
 public:
  bool has(const char* key) const;
  /// returns the value of a key that must exist; if the key is missing, notes a problem and returns allowed values
  Tree at(const char* key) const;
  Tree item(size_t index) const;
  size_t count() const;  ///< number of items of a list
  /// Reads a number, or text such as 0x1A. @param unit unit for messages, or "" if there is none
  double number(double least, double most, const char* unit = "") const;
  double whole(double least, double most, const char* unit = "") const;
  uint64_t bits(unsigned width) const;  ///< an exact whole number of up to 64 bits; two's complement if negative
  bool boolean() const;
  std::string text() const;
  /// Returns false and notes a problem if there are other keys. A block under a misspelt key is then read as that of
  /// the nearest key, and so is a number or text that must not be missing.
  /// @param around keys of the mapping around this one, which stand one level too deep here
  /// @param within keys of the mappings in this one, which stand one level too high here
  /// @param where name of these mappings, such as "input or output"
  bool only(std::span<const char* const> keys, std::span<const char* const> around = {},
            std::span<const char* const> within = {}, const char* where = "") const;
  /// makes has() and at() take this value for a key that is not given
  void readInstead(const char* key, const Tree& value) const;
  void fail(const std::string& what) const;  ///< notes the problem "path: what"
  const std::string& path() const { return path_; }
  bool exists() const { return value_ != nullptr; }
  size_t problems() const;  ///< number of problems noted so far in the whole document

 private:
  friend class Document;
  struct Instead;
  const Instead* insteadOf(const std::string& key) const;
  Tree(const void* value, std::string path, void* data) : value_(value), path_(std::move(path)), data_(data) {}
  bool isMapping() const;
  const void* value_;  // nullptr if the value is missing, which has been noted
  std::string path_;
  void* data_;
};

/// A block that stands under a misspelt key or one level too deep, and is read as the one that is meant.
struct ReadInstead {
  std::string written, meant;  ///< paths, such as "wire.ouput" and "wire.output"
};

/// Owns the data that a Tree shows.
class Document {
 public:
  /// @param name name of the document in messages
  Document(const std::string& json, std::string name);
  ~Document();
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;
  Tree root() const;
  /// Throws std::invalid_argument with all problems that were noted, one per line.
  void check() const;
  std::vector<ReadInstead> readInstead() const;  ///< outer blocks come before the blocks in them

 private:
  struct Data;
  friend class Tree;
  std::unique_ptr<Data> data_;
};

}  // namespace hapticd::codec
