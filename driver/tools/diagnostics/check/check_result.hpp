// SPDX-License-Identifier: MIT
/// What `hapticd check` is asked about a file, and what it found.
#pragma once
#include <string>

#include "diagnostics/scene/model_trial.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

struct CheckOptions {
  std::string device;                    ///< device file that takes the place of a scene's devices; "" keeps them
  bool files_only = false;               ///< true only reads the files; no module is called, and no model is set up
  double setup_seconds = kSetupSeconds;  ///< [s] longest time of one call of a plugin in the set-up of a model
};

struct CheckResult {
  std::string file;
  document::Problems problems{}, warnings{};
  bool whole = true;  ///< false if some checks were left out, because something that they need is missing or wrong
  bool hands_moved = false;    ///< true if the hands of a scene with problems were moved through its sound models
  bool hand_left_out = false;  ///< true if the scene gives a hand, but it was not moved, because of the problems
};

}  // namespace hapticd::diagnostics
