// SPDX-License-Identifier: MIT
#include "diagnostics/reading/key_place.hpp"

#include <cstdlib>
#include <vector>

#include "document/node.hpp"
#include "document/table.hpp"

namespace hapticd::diagnostics {
namespace {

/// Returns the node for a part of a path, such as "name[3]", in a mapping.
const document::Node* step(const document::Node& from, const std::string& part) {
  const size_t bracket = part.find('[');
  const document::Node* at = from.isMap() ? from.find(part.substr(0, bracket)) : nullptr;
  for (size_t open = bracket; at != nullptr && open != std::string::npos; open = part.find('[', open + 1)) {
    const size_t index = std::strtoul(part.c_str() + open + 1, nullptr, 10);
    // also if it is a mapping, because the dashes of the list are missing
    const std::vector<const document::Node*> elements = document::elementsOf(*at);
    at = index < elements.size() ? elements[index] : nullptr;
  }
  return at;
}

}  // namespace

std::optional<document::Place> placeOfKey(const document::Node& root, const std::filesystem::path& file,
                                          const std::string& key) {
  const document::Node* at = &root;
  for (size_t begin = 0; at != nullptr && begin <= key.size();) {
    const size_t end = std::min(key.find('.', begin), key.size());
    at = step(*at, key.substr(begin, end - begin));
    begin = end + 1;
  }
  if (at == nullptr) return std::nullopt;
  return document::Place{file.string(), at->line, at->column};
}

std::optional<document::Place> placeOfKey(const std::filesystem::path& file, const std::string& key) {
  document::Problems unread;
  const auto root = document::readFileOn(file, unread);
  return root ? placeOfKey(*root, file, key) : std::nullopt;
}

document::Place placeInModel(const scene::Model& model, const std::string& key) {
  return placeOfKey(model.place.file, key).value_or(model.place);
}

void reportInModel(document::Problems& problems, const scene::Scene& scene, size_t index, const char* key,
                   const std::string& what) {
  const std::string full = "models[" + std::to_string(index) + "]." + key;
  document::report(problems, placeInModel(scene.models[index], full), full, what);
}

}  // namespace hapticd::diagnostics
