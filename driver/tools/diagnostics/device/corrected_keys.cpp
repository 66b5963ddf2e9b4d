// SPDX-License-Identifier: MIT
#include "diagnostics/device/corrected_keys.hpp"

#include <algorithm>
#include <ranges>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/nearest_word.hpp"
#include "codec/wire.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Entry;
using document::Node;

/// Returns true if a value, or one below it, stands at this place.
bool holds(const Node& node, const document::Place& place) {
  const auto inside = [&place](const Node& one) { return holds(one, place); };
  return (node.line == place.line && node.column == place.column) ||
         std::any_of(node.items.begin(), node.items.end(), inside) ||
         std::any_of(node.entries.begin(), node.entries.end(), [&](const Entry& one) { return inside(one.value); });
}

Entry* entryOf(Node& map, const std::string& key) {
  const auto found =
      std::find_if(map.entries.begin(), map.entries.end(), [&key](const Entry& one) { return one.key.scalar == key; });
  return found == map.entries.end() ? nullptr : &*found;
}

/// Renames the keys above a value so that it has this path.
void nameAs(Node& map, const std::string& path, const document::Place& place) {
  const size_t point = path.find('.');
  const std::string key = path.substr(0, point);
  const bool last = point == std::string::npos;
  Entry* entry = entryOf(map, key);
  for (size_t i = 0; entry == nullptr && i < map.entries.size(); ++i)
    if (const Node& value = map.entries[i].value; (last || value.isMap()) && holds(value, place))
      entry = &map.entries[i], entry->key.scalar = key;
  if (entry != nullptr && !last) nameAs(entry->value, path.substr(point + 1), place);
}

/// Returns the value at a path below a mapping; nullptr if there is none.
Node* at(Node& map, const std::string& path) {
  if (path.empty()) return &map;
  const size_t end = std::min(path.find('.'), path.size()), bracket = path.find('[');
  Entry* entry = entryOf(map, path.substr(0, std::min(end, bracket)));
  if (entry == nullptr) return nullptr;
  Node* value = &entry->value;
  for (size_t open = bracket; open < end; open = path.find('[', open + 1)) {
    const size_t index = std::stoul(path.substr(open + 1));
    if (index >= value->items.size()) return nullptr;
    value = &value->items[index];
  }
  return at(*value, end == path.size() ? "" : path.substr(end + 1));
}

std::pair<std::string, std::string> split(const std::string& path) {
  const size_t point = path.rfind('.');
  return {path.substr(0, point), path.substr(point + 1)};
}

/// Moves the value at one path to another, whose mapping exists.
void move(Node& root, const std::string& from, const std::string& to) {
  const auto [from_map, from_key] = split(from);
  const auto [to_map, to_key] = split(to);
  Node* source = at(root, from_map);
  Entry* entry = source == nullptr ? nullptr : entryOf(*source, from_key);
  if (entry == nullptr) return;
  Entry moved = std::move(*entry);
  source->entries.erase(source->entries.begin() + (entry - source->entries.data()));
  moved.key.scalar = to_key;
  if (Node* target = at(root, to_map)) target->entries.push_back(std::move(moved));
}

}  // namespace

Node withCorrectedParameters(Node root, const scene::Device& draft) {
  if (root.find("parameters") == nullptr)
    for (Entry& entry : root.entries)
      if (!nearestWord(entry.key.scalar, {"parameters"}).empty()) {
        entry.key.scalar = "parameters";
        break;
      }
  if (Entry* parameters = entryOf(root, "parameters"))
    for (const scene::Value& value : draft.parameters) nameAs(parameters->value, value.id, value.place);
  return root;
}

Node withCorrectedWire(Node root, const scene::Device& draft) {
  const scene::Value* wire = givenIn(draft.parameters, "wire");
  if (wire == nullptr) return root;
  std::vector<codec::ReadInstead> moves;
  try {
    moves = codec::misplacedInWire(wire->text, 0);
  } catch (const std::invalid_argument&) {
    return root;
  }
  for (const auto& [written, meant] : moves | std::views::reverse)  // inner blocks first: their paths are as written
    move(root, "parameters." + written, "parameters." + meant);
  return root;
}

}  // namespace hapticd::diagnostics
