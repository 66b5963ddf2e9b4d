// SPDX-License-Identifier: MIT
/// A YAML or JSON file as a tree, and the line and column of each value.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "document/problem.hpp"

namespace hapticd {

/// A step from a value to a value inside it: a key, or an index if the key is empty.
struct PathStep {
  std::string key;
  std::size_t index = 0;
};
using Path = std::vector<PathStep>;

/// Collects the problems of one file, each with line and column. The positions are found by reading the file a second
/// time, and only if there is a problem. So JSON files of tens of megabytes load as fast as with a plain JSON reader.
class Problems {
 public:
  Problems(std::string file, const std::string& text) : file_(std::move(file)), text_(text) {}
  void add(const Path& path, const std::string& what);
  /// Adds what was found when the text was parsed, such as keys that are given twice.
  void add(const document::Problems& of_text) { of_text_.insert(of_text_.end(), of_text.begin(), of_text.end()); }
  bool any() const { return !found_.empty() || !of_text_.empty(); }
  std::size_t count() const { return found_.size(); }
  /// Returns true if some problem is about this key, or a value inside it, anywhere in the file.
  bool about(const std::string& key) const;
  bool full() const;
  /// [main] Returns the problems, each as `file:line:column: key: what`.
  std::vector<std::string> texts() const;
  /// [main] @throws ModelFileError with all problems, if there are any. @param odd warnings about the other values
  void throwIfAny(std::vector<std::string> odd = {}) const;

 private:
  std::vector<document::Problem> placed() const;
  struct Problem {
    Path path;
    std::string what;
  };
  std::string file_;
  const std::string& text_;
  std::vector<Problem> found_;
  document::Problems of_text_;
};

/// [main] Returns the whole text of a model file. @throws ModelFileError if it cannot be read or is larger than 32 MiB.
std::string readModelText(const std::string& path);

/// [main] Returns the text as a tree. Numbers become numbers, including `.nan` and `.inf`; other scalars of YAML stay
/// texts, except true and false. After a syntax error it reads on.
/// @param problems receives what is wrong with the text
/// @throws ModelFileError if it is neither YAML nor JSON.
nlohmann::json parseDocument(const std::string& text, const std::string& file, Problems& problems);

}  // namespace hapticd
