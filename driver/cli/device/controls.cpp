// SPDX-License-Identifier: MIT
/// `hapticd device controls`: prints which controls (safety measures against hazards) one arm has.
#include <memory>
#include <string>

#include "cli/support/command.hpp"
#include "diagnostics/device/arm_controls.hpp"

namespace hapticd::cli {
namespace {

/// The hazards of hazards.md in groups, with a few words for each group.
struct HazardGroup {
  const char *hazards, *words;
};
constexpr HazardGroup kAgainst[] = {{"H4 H6 H8 H9 H13 H17 H21", "wrong numbers, faults"},
                                    {"H16", "too much force"},
                                    {"H18", "a blow"},
                                    {"H1 H2", "false positions or times"},
                                    {"H1", "false positions"},
                                    {"H19", "a push too long or strong"},
                                    {"A3", "running into the stops"},
                                    {"A1", "a burnt winding"},
                                    {"H20", "a force nobody expects"},
                                    {"H23", "a weight that pushes"},
                                    {"H26 H33", "a daemon that stands still"},
                                    {"H30 H32", "a daemon that is gone"},
                                    {"H21", "energy after a fault"},
                                    {"H30", "a machine that stops"},
                                    {"H3", "an arm that falls silent"},
                                    {"H22", "a contact that buzzes"},
                                    {"H5", "an arm without its zero"}};

/// Returns the words for these hazards, or their codes if there are no words.
std::string wordsOf(const std::string& hazards) {
  for (const HazardGroup& against : kAgainst)
    if (hazards == against.hazards) return against.words;
  return hazards;
}

int controls(const std::string& file) {
  document::Problems problems;
  const auto found = diagnostics::controlsOfFile(file, catalog(), problems);
  printProblems(problems, stderr);
  if (!found) return kBadInput;
  const char* state = found->simulated ? "a simulated arm: it has no motors, and nothing is plugged in"
                      : found->opened  ? "plugged in"
                                       : "not plugged in; this is what its file and module say";
  std::printf("%s: %s\n\n%-8s %-30s %-26s %s\n", found->arm.c_str(), state, "", "control", "against", "");
  for (const diagnostics::Control& c : found->controls)
    std::printf("%-8s %-30s %-26s %s (%s)\n", nameOf(c.state), c.name.c_str(), wordsOf(c.hazards).c_str(),
                c.text.c_str(), c.hazards.c_str());
  std::printf("\nThe hazards by their numbers, and the test that shows each control: %s\n",
              guide("hazards.md").c_str());
  return kWorked;
}

}  // namespace

void addDeviceControls(const Command& app, int& exit_code) {
  const Command command =
      app.subcommand("device").addSubcommand("controls",
                                             "Show which safety measures (of driver/docs/hazards.md) an arm has. Opens "
                                             "the arm if it is plugged in, but moves nothing.");
  auto file = std::make_shared<std::string>();
  command.addOption("file", *file, "device file (YAML)").required();
  command.footer("Example:\n  hapticd device controls config/devices/premium15.yaml");
  command.callback([file, &exit_code] { exit_code = controls(*file); });
}

}  // namespace hapticd::cli
