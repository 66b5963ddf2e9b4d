// SPDX-License-Identifier: MIT
#include "scene/path_rows.hpp"

#include "document/csv.hpp"
#include "document/node.hpp"
#include "document/table.hpp"
#include "scene/kinematic_path.hpp"

namespace hapticd::scene {

PathKey keyOfPath(const Model& model) {
  document::Problems unread;
  const auto root = document::readFileOn(model.place.file, unread);
  const document::Node* models = root ? root->find("models") : nullptr;
  if (models == nullptr) return {model.place, {}};
  for (const document::Node* node : document::elementsOf(*models)) {
    if (node->line != model.place.line || node->column != model.place.column) continue;
    const document::Node *path = node->find("path"), *parameters = node->find("parameters");
    if (path == nullptr && parameters != nullptr) path = parameters->find("path");
    if (path != nullptr)
      return {{model.place.file, path->line, path->column},
              std::filesystem::path(model.place.file).parent_path() / path->scalar};
  }
  return {model.place, {}};
}

std::optional<int> lineOfRow(const std::filesystem::path& csv, size_t row, double t) {
  const auto table = csv.empty() ? std::nullopt : document::readSoundRows(csv, kMaxPathBytes, kinematicPathRules());
  if (!table || row >= table->rows() || table->row(row)[0] != t) return std::nullopt;
  return table->lines[row];
}

}  // namespace hapticd::scene
