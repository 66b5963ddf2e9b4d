// SPDX-License-Identifier: MIT
/// `hapticd check`: validates files and prints every problem, warns of what cannot be stable; also prints the JSON
/// Schema of a format.
#include <memory>
#include <vector>

#include "cli/command.hpp"
#include "diagnostics/device_trial.hpp"
#include "diagnostics/model_trial.hpp"
#include "host/device_instance.hpp"
#include "tune/stability.hpp"

namespace hapticd::cli {

using namespace diagnostics;
namespace {

struct Options {
  std::vector<std::string> files;
  std::string schema;
  bool quiet = false, files_only = false;
};

int printSchema(const std::string& format) {
  std::fputs(scene::jsonSchema(format, &catalog()).c_str(), stdout);
  return kWorked;
}

/// What cannot be stable. Only simulated arms are opened: `check` touches no hardware; `run` warns of it as well.
document::Problems unstable(const scene::Scene& scene, const std::vector<double>& stiffness) {
  document::Problems warnings = tune::fastPaths(scene);
  std::vector<scene::Device> devices = scene.devices;
  if (const auto file = host::shippedFile(scene::kDefaultDevice); devices.empty() && file)  // as `run` will
    if (auto loaded = scene::loadDevice(*file, catalog()); loaded.device) devices.push_back(*loaded.device);
  for (const scene::Device& device : devices) {
    if (device.module != "simulated") continue;
    auto arm = host::DeviceInstance::create(device, nullptr);
    if (!arm || !(*arm)->open()) continue;
    const document::Problems found = tune::unstableSettings(scene, device, (*arm)->info(), stiffness);
    warnings.insert(warnings.end(), found.begin(), found.end());
  }
  return warnings;
}

int check(const Options& options) {
  if (!options.schema.empty()) return printSchema(options.schema);
  if (options.files.empty()) return fail(kBadInput, "no file given, expected `hapticd check FILE...`");
  size_t problems = 0, bad_files = 0;
  for (const std::string& file : options.files) {
    std::optional<scene::Scene> scene;
    document::Problems found = scene::checkFile(file, catalog(), &scene);
    ModelTrial trial;
    if (scene && !options.files_only) trial = tryModels(*scene);
    found.insert(found.end(), trial.problems.begin(), trial.problems.end());
    if (!scene && found.empty()) found = tryDevice(file, catalog());
    printProblems(found, stdout);
    printWarnings(trial.warnings, stdout);
    if (scene && found.empty()) printWarnings(unstable(*scene, trial.stiffness), stdout);
    if (found.empty() && !options.quiet) std::printf("%s: ok\n", file.c_str());
    problems += found.size();
    bad_files += found.empty() ? 0 : 1;
  }
  if (problems == 0) return kWorked;
  std::fflush(stdout);
  std::fprintf(stderr, "%zu problem%s in %zu of %zu file%s\n", problems, problems == 1 ? "" : "s", bad_files,
               options.files.size(), options.files.size() == 1 ? "" : "s");
  return kBadInput;
}

}  // namespace

void addCheck(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("check", "Validate scene, device and daemon files; print every problem.");
  command->add_option("files", options->files, "files to check");
  command->add_option("--schema", options->schema, "print the JSON Schema of a format instead, for editors")
      ->check(CLI::IsMember({"scene", "device", "daemon"}));
  command->add_flag("--quiet,-q", options->quiet, "print nothing about files without problems");
  command->add_flag("--files-only", options->files_only, "only read the files; do not set up the models of a scene");
  command->footer(
      "Each problem is one line: file:line:column: key: what is wrong, and what was expected.\nThe exit code is 2 if "
      "there is a problem. If a scene has none, its models are set up once, because only\na plugin can check some "
      "files, such as geometry. A warning names each setting that cannot be stable on\nthe device, with the bound and "
      "the nearest stable setting. Warnings do not affect the exit code.\n\nExample:\n  hapticd check "
      "config/scenes/teapot.yaml config/devices/simulated-premium15.yaml\n  hapticd check --schema scene > "
      "scene.schema.json");
  command->callback([options, &exit_code] { exit_code = check(*options); });
}

}  // namespace hapticd::cli
