// SPDX-License-Identifier: MIT
/// `hapticd import --scene`: writes a first scene for what was imported.
#pragma once
#include <string>

#include "import/bezier_import.hpp"

namespace hapticd::cli {

struct FirstScene {
  std::string from;   ///< the file that was imported
  std::string model;  ///< what was made of it
  std::string scene;  ///< file to write
  importing::Placement placement;
  bool soft = false;    ///< the model is a soft body
  bool silent = false;  ///< prints only warnings and errors
};

/// [main] Returns why no scene can be written, or "". Nothing is written yet.
std::string whyNoScene(const std::string& scene, const std::string& model);

/// [main] Writes the scene and prints what to do with it, or the error. @return the exit code
int writeFirstScene(const FirstScene& first);

}  // namespace hapticd::cli
