// SPDX-License-Identifier: MIT
/// Tells which files are models, as `hapticd import` writes them.
#pragma once
#include <string>

namespace hapticd::cli {

enum class ModelFile {
  kNone,   ///< no model
  kRigid,  ///< a part or surfaces, for nurbs_rigid
  kSoft    ///< a soft body, for mat_deformable
};

/// [main] Returns what a file is, by its name, and of YAML and JSON by its keys. The plugin reports what is wrong in
/// it.
ModelFile modelFileOf(const std::string& file);

}  // namespace hapticd::cli
