// SPDX-License-Identifier: MIT
/// Reads the parameters of a model or device, and checks them against the table of its plugin or module.
#pragma once
#include <vector>

#include "description/class_info.hpp"
#include "description/scene.hpp"
#include "document/reader.hpp"

namespace hapticd::scene {

using document::Entry;
using document::Node;
using document::Reader;

class ParameterReader {
 public:
  ParameterReader(Reader& in, const host::ClassInfo& info)
      : in_(&in), info_(info), given_(info.params.size()), given_as_(info.params.size()), seen_(info.params.size()) {}

  /// From now on, the nodes that are read belong to another file. Their values replace earlier values.
  void overrideFrom(Reader& in);

  /// Reads a mapping. The names of nested mappings become ids with dots, such as "hand.mass". @param key key of the
  /// mapping, such as "models[2].parameters"
  /// @param prefix text before each id, such as "hand" for a mapping with the parameters hand.*
  /// @param skip name of an entry of the mapping that is not a parameter
  void read(const Node& node, const std::string& key, const std::string& prefix = "", const std::string& skip = "");

  /// Reads one parameter that is not part of a mapping of parameters.
  void readOne(const Node& node, const std::string& key, uint32_t index);

  /// Reports required parameters that are missing. @param at node where they were expected
  void requireAll(const Node& at, const std::string& key);

  std::vector<Value> take() { return std::move(values_); }

 private:
  void nothing(const Entry& entry, const std::string& key, uint32_t index);
  void unknown(const Node& around, const Entry& entry, const std::string& key, const std::string& id);
  /// Reads the value of an unknown key as that of the parameter or group that is meant, to find problems in it, too.
  void judgeAs(const std::string& meant, const Entry& entry, const std::string& key);
  bool readValue(const Node& node, const std::string& key, const host::ParamInfo& param, Value& value);
  bool readArray(const Node& node, const std::string& key, const host::ParamInfo& param, Value& value);
  bool readPath(const Node& node, const std::string& key, Value& value);

  Reader* in_;
  const host::ClassInfo& info_;
  std::vector<Value> values_;
  std::vector<int> given_;  // line of each parameter in the file being read, even if its value is wrong; 0: not given
  std::vector<std::string> given_as_;  // key of each parameter that was given
  std::vector<bool> seen_;             // true for parameters that were given in any file
};

}  // namespace hapticd::scene
