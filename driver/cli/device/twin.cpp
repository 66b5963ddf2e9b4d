// SPDX-License-Identifier: MIT
/// `hapticd device twin`: writes the device file of a simulated arm with the mechanism of a real one.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "base/shell_word.hpp"
#include "cli/device/file.hpp"
#include "cli/support/command.hpp"
#include "diagnostics/device/device_trial.hpp"
#include "diagnostics/device/device_twin.hpp"
#include "diagnostics/hand/hand_start.hpp"
#include "document/node.hpp"

namespace hapticd::cli {
namespace {

/// Checks whether the twin that was written can be run. @return an exit code
int checkTwinFile(const std::string& file, const std::string& out) {
  const scene::LoadedDevice twin = scene::loadDevice(out, catalog());
  document::Problems problems = twin.problems;
  if (problems.empty()) problems = diagnostics::tryDevice(out, catalog());
  printProblems(problems, stderr);
  if (!problems.empty() || !twin.device)
    return fail(kFailed, out + " is written, but cannot be used yet\n  fix: hapticd check " + shellWord(file) +
                             ", then rm " + shellWord(out) + " and write the twin anew");
  scene::Scene alone;
  alone.devices.push_back(*twin.device);
  problems = diagnostics::refusedArms(alone, false);
  printProblems(problems, stderr);
  if (problems.empty()) return kWorked;
  return fail(kFailed,
              out + " was written, but its hand cannot reach its start position\n  fix: correct mount in " + file +
                  ", which says where the arm stands (shapes and hand are near the world's origin; without "
                  "mount, a chain is placed automatically), or arm.lengths or arm.limits, which say how far it "
                  "reaches; then write the twin again");
}

int makeTwin(const std::string& file, const std::string& wanted) {
  namespace fs = std::filesystem;
  if (!loadDeviceOrReport(file))
    return fail(kBadInput,
                file + " has problems, so no twin was written\n  fix: correct them, then write the twin again");
  document::Problems problems;
  const auto root = document::parseFile(file, problems);
  if (!root) return kBadInput;
  const auto text = diagnostics::twinOf(*root, fs::path(file).filename().string());
  if (!text) return fail(kBadInput, text.error());
  const std::string out = wanted.empty() ? fs::path(file).stem().string() + "-twin.yaml" : wanted;
  std::error_code error;
  if (fs::exists(out, error)) return fail(kBadInput, out + " exists already, expected the name of a new file");
  std::ofstream stream(out);
  stream << *text << std::flush;
  if (!stream) {
    const bool begun = stream.is_open();
    if (begun) fs::remove(out, error);  // a file that is not complete
    return fail(begun ? kFailed : kBadInput,
                out + ": cannot be written, expected a disk with room and a folder that you may write to");
  }
  if (const int wrong = checkTwinFile(file, out); wrong != kWorked) return wrong;
  if (const std::string borrowed = diagnostics::borrowedByTwin(*root); !borrowed.empty())
    std::fprintf(stderr, "warning: %s: %s\n", file.c_str(), borrowed.c_str());
  std::printf("%s\n\nthen:\n  hapticd check SCENE.yaml --device %s\n  hapticd run SCENE.yaml --device %s --view\n",
              out.c_str(), shellWord(out).c_str(), shellWord(out).c_str());
  return kWorked;
}

}  // namespace

void addDeviceTwin(const Command& app, int& exit_code) {
  const Command command = app.subcommand("device").addSubcommand(
      "twin", "Write a device file of a simulated arm with the kinematics, limits and encoders of another file's arm.");
  auto file = std::make_shared<std::string>(), out = std::make_shared<std::string>();
  command.addOption("file", *file, "device file of the real arm (YAML)").required();
  command.addOption("-o,--out", *out, "file to write; default: FILE-twin.yaml in the current folder");
  command.footer("Example:\n  hapticd device twin my-arm.yaml && hapticd run scene.yaml --device my-arm-twin.yaml");
  command.callback([file, out, &exit_code] { exit_code = makeTwin(*file, *out); });
}

}  // namespace hapticd::cli
