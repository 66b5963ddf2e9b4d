// SPDX-License-Identifier: MIT
#include "diagnostics/check/warning_places.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "diagnostics/reading/key_place.hpp"
#include "document/node.hpp"

namespace hapticd::diagnostics {
namespace {

/// Finds the places of keys in files. Each file is read once.
class KeyPlaces {
 public:
  std::optional<document::Place> of(const std::string& file, const std::string& key) {
    document::Problems unread;
    const auto [found, is_new] = files_.try_emplace(file);
    if (is_new) found->second = document::readFileOn(file, unread);
    return found->second ? placeOfKey(*found->second, file, key) : std::nullopt;
  }

 private:
  std::map<std::string, std::optional<document::Node>> files_;
};

}  // namespace

void placeWarnings(document::Problems& warnings) {
  document::Problems once;
  std::set<std::tuple<std::string, std::string, int, int, std::string>> told;
  KeyPlaces places;
  for (document::Problem& one : warnings) {
    constexpr std::string_view kPosition = ".position";
    const bool of_pose = one.key.ends_with(".pose") || one.key.ends_with(".pose.position");
    const bool of_model = one.key.starts_with("models[") && (of_pose || one.key.ends_with("].path"));
    if ((one.place.line <= 1 && one.place.column <= 1 && !one.key.empty()) || of_model) {
      auto found = places.of(one.place.file, one.key);
      if (!found && one.key.ends_with(kPosition))
        found = places.of(one.place.file, one.key.substr(0, one.key.size() - kPosition.size()));
      if (found) one.place = *found;
    }
    const bool placed = one.place.line > 1;
    if (!placed || told.emplace(one.key, one.place.file, one.place.line, one.place.column, one.what).second)
      once.push_back(std::move(one));
  }
  warnings = std::move(once);
}

}  // namespace hapticd::diagnostics
