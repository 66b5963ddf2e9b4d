// SPDX-License-Identifier: MIT
/// `hapticd device controls`: which controls of hazards one arm has.
#include <memory>
#include <string>

#include "cli/command.hpp"
#include "diagnostics/arm_controls.hpp"

namespace hapticd::cli {
namespace {

int controls(const std::string& file) {
  document::Problems problems;
  const auto found = diagnostics::controlsOfFile(file, catalog(), problems);
  printProblems(problems, stderr);
  if (!found) return kBadInput;
  std::printf("%s: %s\n\n%-8s %-30s %-25s %s\n", found->arm.c_str(),
              found->opened ? "plugged in" : "not plugged in; by its file and module alone", "", "control", "hazards",
              "");
  for (const diagnostics::Control& c : found->controls)
    std::printf("%-8s %-30s %-25s %s\n", nameOf(c.state), c.name.c_str(), c.hazards.c_str(), c.text.c_str());
  std::printf("\nThe hazards, and the test that shows each control: driver/docs/hazards.md\n");
  return kWorked;
}

}  // namespace

void addDeviceControls(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("device")->add_subcommand(
      "controls", "Show which controls of hazards an arm has. Opens the arm if it is plugged in, but moves nothing.");
  auto file = std::make_shared<std::string>();
  command->add_option("file", *file, "device file (YAML)")->required();
  command->footer("Example:\n  hapticd device controls config/devices/premium15.yaml");
  command->callback([file, &exit_code] { exit_code = controls(*file); });
}

}  // namespace hapticd::cli
