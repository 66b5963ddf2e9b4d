// SPDX-License-Identifier: MIT
#include "tune/path_rows.hpp"

#include "document/csv.hpp"
#include "document/node.hpp"

namespace hapticd::tune {

PathKey keyOfPath(const scene::Model& model) {
  document::Problems unread;
  const auto root = document::readFileOn(model.place.file, unread);
  const document::Node* models = root ? root->find("models") : nullptr;
  if (models == nullptr) return {model.place, {}};
  for (const document::Node& node : models->items) {
    if (node.line != model.place.line || node.column != model.place.column) continue;
    const document::Node *path = node.find("path"), *parameters = node.find("parameters");
    if (path == nullptr && parameters != nullptr) path = parameters->find("path");
    if (path != nullptr)
      return {{model.place.file, path->line, path->column},
              std::filesystem::path(model.place.file).parent_path() / path->scalar};
  }
  return {model.place, {}};
}

std::optional<int> lineOfRow(const std::filesystem::path& csv, size_t row, double t) {
  constexpr size_t kMostBytes = 256u << 20;
  const document::CsvRules rules{{"t,x,y,z,qw,qx,qy,qz", "t,x,y,z"}, true, true};
  const auto table = csv.empty() ? std::nullopt : document::readSoundRows(csv, kMostBytes, rules);
  if (!table || row >= table->rows() || table->row(row)[0] != t) return std::nullopt;
  return table->lines[row];
}

}  // namespace hapticd::tune
