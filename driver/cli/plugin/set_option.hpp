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
  /// [main] Reads and checks the pairs. @param pairs ID=VALUE; VALUE is YAML: a number, a word, [1, 2, 3]; a path is
  /// relative to the current folder
  /// @param classes classes of the plugin file; each ID must be a parameter of one of them
  SetOption(const std::vector<std::string>& pairs, const std::vector<host::ClassInfo>& classes);

  /// [main] Returns the values for the parameters of one class, and leaves out those for other classes.
  std::vector<scene::Value> valuesFor(const host::ClassInfo& info);

  /// Returns one line for each problem so far: what is wrong, and what was expected.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::map<std::string, std::string> given_;
  std::vector<std::string> problems_;
};

/// [main] Returns one line for each required parameter that has no value: its documentation, and the option to give,
/// such as "give --set heights=FILE".
std::vector<std::string> missing(const host::ClassInfo& info, const std::vector<scene::Value>& values);

/// An array that is empty by default, so that tests with defaults do not use it.
struct EmptyArray {
  std::string id, set;  ///< `set`: an option value to try, quoted for a shell, such as "'dent=[0]'"
};

/// [main] Returns the arrays that are empty by default and that have no value in `values`.
std::vector<EmptyArray> emptyArrays(const host::ClassInfo& info, const std::vector<scene::Value>& values);

}  // namespace hapticd::cli
