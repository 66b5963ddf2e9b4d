// SPDX-License-Identifier: MIT
#include "cli/device/file.hpp"

#include "cli/support/command.hpp"
#include "diagnostics/device/device_trial.hpp"

namespace hapticd::cli {

document::Problems problemsOfDevice(const std::string& file) {
  document::Problems problems = scene::loadDevice(file, catalog()).problems;
  document::append(problems, diagnostics::tryDevice(file, catalog(), problems));
  document::sortByPlace(problems);
  return problems;
}

std::optional<scene::Device> loadDeviceOrReport(const std::string& file) {
  const document::Problems problems = problemsOfDevice(file);
  printProblems(problems, stderr);
  return problems.empty() ? scene::loadDevice(file, catalog()).device : std::nullopt;
}

}  // namespace hapticd::cli
