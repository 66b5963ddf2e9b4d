// SPDX-License-Identifier: MIT
#include "document/table.hpp"

#include <algorithm>

#include "document/suggestion.hpp"

namespace hapticd::document {

const Key* Table::find(std::string_view name) const {
  for (const Key& key : keys)
    if (name == key.name) return &key;
  return nullptr;
}

std::vector<std::string> Table::names() const {
  std::vector<std::string> all;
  for (const Key& key : keys) all.emplace_back(key.name);
  return all;
}

std::string Key::expected() const {
  switch (type) {
    case Type::kReal:
      return "a number, " + expectedOf(range);
    case Type::kInteger:
      return range.min == range.max ? numberText(range.min) : "a whole number, " + expectedOf(range);
    case Type::kBool:
      return "true or false";
    case Type::kChoice:
      return "one of " + listed(detail::texts(choices));
    case Type::kName:
      return "a name";
    case Type::kText:
      return "a text";
    case Type::kFile:
      return "the path of a file";
    case Type::kVector3:
      return "a list of 3 numbers, " + expectedOf(range);
    case Type::kQuaternion:
      return "a unit quaternion [w, x, y, z]";
    case Type::kObject:
      return "a mapping with " + listed(table->names());
    case Type::kList:
      return "a list of at most " + numberText(range.max) + " mappings with " + listed(table->names());
    case Type::kAny:
      return shape;
  }
  return "";
}

std::vector<const Node*> elementsOf(const Node& list) {
  std::vector<const Node*> elements;
  for (const Node& item : list.items) elements.push_back(&item);
  const auto isMap = [](const Entry& entry) { return entry.value.isMap(); };
  if (std::all_of(list.entries.begin(), list.entries.end(), isMap))
    for (const Entry& entry : list.entries) elements.push_back(&entry.value);
  else
    elements.push_back(&list);
  return elements;
}

std::vector<std::string> detail::texts(std::span<const std::string_view> words) {
  return {words.begin(), words.end()};
}

}  // namespace hapticd::document
