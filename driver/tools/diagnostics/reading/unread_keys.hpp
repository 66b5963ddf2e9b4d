// SPDX-License-Identifier: MIT
/// The keys of a scene with problems whose values could not be read, so that no check relies on them.
#pragma once
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "description/class_info.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// The keys and parameters of one model that could not be read.
struct UnreadModel {
  std::set<std::string, std::less<>> ids;  ///< parameters whose values are wrong
  std::set<std::string, std::less<>> own;  ///< keys of the model itself: "pose", "path", "motion", ...
  bool any = false;      ///< true if a key is unknown and resembles no other: it may stand for any key that is absent
  bool gravity = false;  ///< true if servo.gravity could not be read

  /// Returns true if every key of the model was read. Keys of other parts of the scene do not count.
  bool sound() const { return ids.empty() && own.empty() && !any; }
  bool hasOwn(std::string_view key) const { return own.contains(key); }
};

class UnreadKeys {
 public:
  UnreadKeys() = default;
  explicit UnreadKeys(const document::Problems& problems);

  /// Returns true if there is a problem with this key, with the mapping that contains it, or with a part of its value.
  bool has(std::string_view key) const;
  /// Returns the keys of a model that could not be read. @param info description of its plugin
  UnreadModel ofModel(size_t index, const host::ClassInfo& info) const;
  /// Returns true if only the key of a parameter is wrong, so that its value was read all the same: the key is
  /// misspelt, or stands beside `parameters`, such as "models[2].stiffness".
  static bool isReadAsMeant(const document::Problem& one, const host::ClassInfo& info);

 private:
  void addOwn(const std::string& key, UnreadModel& model) const;
  void addParameter(const std::string& key, const host::ClassInfo& info, UnreadModel& model) const;

  std::vector<std::string> keys_;                   ///< all keys outside of models
  std::map<size_t, document::Problems> of_models_;  ///< problems of each model
};

}  // namespace hapticd::diagnostics
