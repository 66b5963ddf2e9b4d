// SPDX-License-Identifier: MIT
/// The results of `hapticd run` after its end: summary, report and picture.
#pragma once
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "session/run/runner.hpp"

namespace hapticd::cli {

struct RunOutcome {
  std::string scene, report, picture, record;  ///< files; "" for those that were not asked for
  double rate = 0;                             ///< [Hz] rate that was asked for
  bool virtual_time = false;
  Nanoseconds program_start = 0;      ///< when the program began
  std::vector<std::string> left_out;  ///< messages for models that were left out
};

/// Prints the summary and writes the files that were asked for. @return the exit code of the run
int conclude(const RunOutcome& outcome, servo::Runner& runner);

}  // namespace hapticd::cli
