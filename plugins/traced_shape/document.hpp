// SPDX-License-Identifier: MIT
/// A YAML or JSON file as one tree, and where in the file each value stands.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "document/problem.hpp"

namespace hapticd {

/// A step from a value to one inside it: a key or an index.
struct PathStep {
  std::string key;
  std::size_t index = 0;
};
using Path = std::vector<PathStep>;

/// Gathers the problems of one file and prefixes them with line and column. Positions are looked up only when something
/// is wrong, by reading the file a second time: JSON of tens of megabytes loads at the speed of a plain JSON reader.
class Problems {
 public:
  Problems(std::string file, const std::string& text) : file_(std::move(file)), text_(text) {}
  void add(const Path& path, const std::string& what);
  bool any() const { return !found_.empty(); }
  bool full() const;
  /// [main] Each as `file:line:column: key: what`.
  std::vector<std::string> texts() const;
  /// [main] @throws ModelFileError if there are any.
  void throwIfAny() const;

 private:
  std::vector<document::Problem> placed() const;
  struct Problem {
    Path path;
    std::string what;
  };
  std::string file_;
  const std::string& text_;
  std::vector<Problem> found_;
};

/// [main] All of a model file. @throws ModelFileError if it cannot be read or is larger than 32 MiB.
std::string readModelText(const std::string& path);

/// [main] The text as a tree. Numbers become numbers, `.nan` and `.inf` too (as not-a-number and infinity); everything
/// else of YAML's scalars stays text. @throws ModelFileError if it is neither YAML nor JSON.
nlohmann::json parseDocument(const std::string& text, const std::string& file);

}  // namespace hapticd
