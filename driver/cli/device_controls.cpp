// SPDX-License-Identifier: MIT
/// `hapticd device controls`: which controls of hazards one arm has.
#include <memory>
#include <string>

#include "cli/command.hpp"
#include "diagnostics/arm_controls.hpp"
#include "diagnostics/device_trial.hpp"

namespace hapticd::cli {
namespace {

/// An arm that is not there is no error here: what it alone can say is unknown then.
void logNothing(int, const std::string&, const std::string&) {}

int controls(const std::string& file) {
  const scene::LoadedDevice loaded = scene::loadDevice(file, catalog());
  printProblems(loaded.problems, stderr);
  if (!loaded.device) return kBadInput;
  const document::Problems wrong = diagnostics::tryDevice(file, catalog());
  printProblems(wrong, stderr);
  if (!wrong.empty()) return kBadInput;
  auto device = host::DeviceInstance::create(*loaded.device, logNothing);
  if (!device) return fail(kFailed, device.error());
  const bool opened = static_cast<bool>((*device)->open());
  std::printf("%s: %s\n\n%-8s %-30s %-25s %s\n", loaded.device->name.c_str(),
              opened ? "plugged in" : "not plugged in; by its file and module alone", "", "control", "hazards", "");
  for (const diagnostics::Control& c : diagnostics::controlsOf(*loaded.device, **device, opened))
    std::printf("%-8s %-30s %-25s %s\n", nameOf(c.verdict), c.name.c_str(), c.hazards.c_str(), c.text.c_str());
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
