// SPDX-License-Identifier: MIT
#include "cli/support/model_file.hpp"

#include "base/file_ending.hpp"
#include "document/node.hpp"

namespace hapticd::cli {

ModelFile modelFileOf(const std::string& file) {
  const std::string ending = endingOf(file);
  if (ending == ".hpart") return ModelFile::kRigid;
  if (ending == ".ma") return ModelFile::kSoft;
  if (ending != ".yaml" && ending != ".yml" && ending != ".json") return ModelFile::kNone;
  document::Problems ignored;
  const auto root = document::parseFile(file, ignored);
  if (!root || !root->isMap() || root->find("format") == nullptr) return ModelFile::kNone;
  return root->find("medial") != nullptr ? ModelFile::kSoft : ModelFile::kRigid;
}

}  // namespace hapticd::cli
