// SPDX-License-Identifier: MIT
/// `--set ID=VALUE`: parameters on the command line, read and checked like those of a scene.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "description/class_info.hpp"
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::cli {

class SetOption {
 public:
  /// [main] @param pairs ID=VALUE; VALUE is YAML: a number, a word, [1, 2, 3]; a path is seen from the current folder.
  /// @param classes of the file: an ID must belong to one of them
  SetOption(const std::vector<std::string>& pairs, const std::vector<host::ClassInfo>& classes);

  /// [main] The values for one class; values for other classes are left out.
  std::vector<scene::Value> valuesFor(const host::ClassInfo& info);

  /// Everything that was wrong so far, one line each: what is wrong, and what was expected.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::map<std::string, std::string> given_;
  std::vector<std::string> problems_;
};

/// [main] "--set heights=FILE" for each required parameter that has no value, with what it is.
std::vector<std::string> missing(const host::ClassInfo& info, const std::vector<scene::Value>& values);

}  // namespace hapticd::cli
