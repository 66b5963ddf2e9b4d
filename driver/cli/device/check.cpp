// SPDX-License-Identifier: MIT
/// `hapticd device check FILE`: examines a device module, each part in a child process of its own.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/counted.hpp"
#include "cli/support/colour.hpp"
#include "cli/support/command.hpp"
#include "cli/support/shared_object.hpp"
#include "device_check/device_check.hpp"
#include "device_check/module_recipe.hpp"

namespace hapticd::cli {
namespace {

using device_check::Outcome;
using Passed = device_check::Verdict;

struct ExamineArguments {
  std::string file;
  bool json = false;
  double timeout = 10;
};

/// Returns the arm of a device file, or the arms of a module file.
Result<std::vector<scene::Device>> devicesOf(const ExamineArguments& options) {
  if (isSharedObject(options.file)) return device_check::devicesIn(options.file);
  const scene::LoadedDevice loaded = scene::loadDevice(options.file, catalog());
  printProblems(loaded.problems, stderr);
  if (loaded.device) return std::vector<scene::Device>{*loaded.device};
  return Error{options.file + " is neither a valid device file nor a module (FILE.so); see above"};
}

const char* wordFor(Passed verdict) {
  switch (verdict) {
    case Passed::kPassed:
      return "ok";
    case Passed::kWarned:
      return "warn";
    case Passed::kSkipped:
      return "skip";
    default:
      return "FAIL";
  }
}

void print(const Outcome& outcome) {
  const Colour colour = outcome.found.verdict == Passed::kPassed   ? Colour::kGood
                        : outcome.found.verdict == Passed::kFailed ? Colour::kBad
                                                                   : Colour::kWarning;
  const std::string word = wordFor(outcome.found.verdict);
  std::printf("%s%-*s %-24s %s\n", coloured(word, colour).c_str(), static_cast<int>(5 - word.size()), "", outcome.name,
              outcome.found.what.c_str());
  std::fflush(stdout);
}

/// Runs the tests of one device. Stops after a test that crashes or hangs, or that fails and is needed by the tests
/// after it.
std::vector<Outcome> examine(const scene::Device& device, const ExamineArguments& options) {
  std::vector<Outcome> outcomes;
  for (const device_check::Test& test : device_check::tests()) {
    outcomes.push_back(device_check::tryOne(test, device, static_cast<int>(options.timeout * 1000)));
    if (!options.json) print(outcomes.back());
    if (outcomes.back().found.ends) break;
  }
  return outcomes;
}

/// Returns what to do about the test after which the others were not run.
const char* wayOn(const Outcome& last) {
  return last.found.verdict == Passed::kSkipped ? "they need the arm" : "first correct what stopped them";
}

int sum(const std::vector<Outcome>& outcomes, const ExamineArguments& options, const std::string& module,
        nlohmann::ordered_json& all) {
  int failed = 0, skipped = 0, warned = 0;
  for (const Outcome& one : outcomes) {
    skipped += one.found.verdict == Passed::kSkipped ? 1 : 0;
    failed += one.found.verdict == Passed::kFailed ? 1 : 0;
    warned += one.found.verdict == Passed::kWarned ? 1 : 0;
    const char* result = one.found.verdict == Passed::kFailed ? "fail" : wordFor(one.found.verdict);
    all["tests"].push_back({{"module", module}, {"name", one.name}, {"result", result}, {"what", one.found.what}});
  }
  const size_t run = outcomes.size() - static_cast<size_t>(skipped), all_tests = device_check::tests().size();
  const bool ended = outcomes.size() < all_tests;
  std::string rest;
  if (ended)
    rest = ", " + std::to_string(all_tests - run) + " not run: " + wayOn(outcomes.back());
  else if (skipped > 0)
    rest = ", " + std::to_string(skipped) + " skipped";
  if (!options.json)
    std::printf("%s, %d failed%s%s\n", counted(run, "test").c_str(), failed,
                warned == 0 ? "" : (", " + counted(static_cast<uint64_t>(warned), "warning")).c_str(), rest.c_str());
  return failed;
}

int check(const ExamineArguments& options) {
  const auto devices = devicesOf(options);
  if (!devices) return fail(kBadInput, devices.error());
  nlohmann::ordered_json all{{"file", options.file}, {"failed", 0}, {"tests", nlohmann::ordered_json::array()}};
  int failed = 0;
  for (const scene::Device& device : *devices) {
    if (!options.json) std::printf("%s (%s)\n", device.module.c_str(), device.library.c_str());
    failed += sum(examine(device, options), options, device.module, all);
  }
  all["failed"] = failed;
  if (options.json) printJson(all);
  return failed == 0 ? kWorked : kFailed;
}

}  // namespace

void addDeviceCheck(const Command& app, int& exit_code) {
  auto options = std::make_shared<ExamineArguments>();
  const Command command = app.subcommand("device").addSubcommand(
      "check", "Examine a device module with motors off: kinematics, what open() claims, samples, cost of read().");
  command.addOption("file", options->file, "device file (YAML), or a module (FILE.so) with its defaults")
      .required()
      .existingFile();
  command.addFlag("--json", options->json, "print JSON");
  command.addOption("--timeout", options->timeout, "longest time of one test [s]; a longer one counts as a hang")
      .showDefault()
      .within(0.1, 3600.0);
  command.footer(
      "Each test runs in a process of its own, so that a crash or a hang names the call in which it came. Opens the "
      "arm if\nit is plugged in and reads it for half a second; every command says that the motors are off. If the "
      "arm\nis not plugged in, only its kinematics are tested. The exit code is 1 if a test fails.\n\n"
      "Examples:\n  hapticd device check my-arm.yaml\n  hapticd device check build/my_arm.so --json");
  command.callback([options, &exit_code] { exit_code = check(*options); });
}

}  // namespace hapticd::cli
