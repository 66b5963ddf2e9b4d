// SPDX-License-Identifier: MIT
/// `hapticd check`: validates files, prints every problem, and warns of what cannot be stable. It also prints the JSON
/// Schema of a format.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/support/colour.hpp"
#include "cli/support/command.hpp"
#include "diagnostics/check/judge_file.hpp"
#include "document/alike.hpp"
#include "scene/load.hpp"

namespace hapticd::cli {

namespace {

using diagnostics::CheckResult;
using Json = nlohmann::ordered_json;

struct CheckArguments {
  std::vector<std::string> files;
  std::string schema;
  bool quiet = false, json = false;
  diagnostics::CheckOptions how;
};

int printSchema(const std::string& format) {
  std::fputs(scene::jsonSchema(format, &catalog()).c_str(), stdout);
  return kWorked;
}

void print(const CheckResult& result, bool quiet) {
  printProblems(result.problems, stdout);
  printWarnings(document::withoutAlike(result.warnings), stdout);
  if (result.problems.empty() && !quiet)
    std::printf("%s: %s\n", result.file.c_str(), coloured("ok", Colour::kGood).c_str());
}

Json toJson(const document::Problems& problems) {
  Json list = Json::array();
  for (const document::Problem& problem : problems)
    list.push_back({{"file", problem.place.file},
                    {"line", problem.place.line},
                    {"column", problem.place.column},
                    {"key", problem.key},
                    {"what", problem.what}});
  return list;
}

int check(const CheckArguments& options) {
  if (!options.schema.empty()) return printSchema(options.schema);
  if (options.files.empty()) return fail(kBadInput, "no file given, expected `hapticd check FILE...`");
  size_t problems = 0, bad_files = 0;
  bool whole = true, hand_left_out = false;
  Json files = Json::array();
  for (const std::string& file : options.files) {
    const CheckResult result = diagnostics::judgeFile(file, options.how, catalog());
    if (options.json)
      files.push_back({{"file", file},
                       {"ok", result.problems.empty()},
                       {"problems", toJson(result.problems)},
                       {"warnings", toJson(result.warnings)}});
    else
      print(result, options.quiet);
    problems += result.problems.size();
    whole = whole && result.whole;
    hand_left_out = hand_left_out || result.hand_left_out;
    bad_files += result.problems.empty() ? 0 : 1;
  }
  if (options.json) printJson({{"problems", problems}, {"files", files}});
  if (problems == 0) return kWorked;
  std::fflush(stdout);
  const size_t all = options.files.size();
  const std::string where = all == 1 ? "1 file" : std::to_string(bad_files) + " of " + std::to_string(all) + " files";
  std::fprintf(stderr, "%zu problem%s in %s%s%s\n", problems, problems == 1 ? "" : "s", where.c_str(),
               whole ? "" : "; some checks can run only after these are corrected, and may find more",
               whole || !hand_left_out ? "" : ": the hand was not moved yet");
  return kBadInput;
}

}  // namespace

void addCheck(const Command& app, int& exit_code) {
  auto options = std::make_shared<CheckArguments>();
  const Command command = app.addSubcommand("check", "Validate scene, device and daemon files; print every problem.");
  command.addOption("files", options->files, "files to check");
  command.addOption("--device", options->how.device,
                    "check the scenes with this device file instead of their own (as hapticd run --device)");
  command.addOption("--schema", options->schema, "print the JSON Schema of a format instead, for editors")
      .oneOf({"scene", "device", "daemon"});
  command
      .addOption("--setup-limit", options->how.setup_seconds,
                 "longest time that a plugin may take for one call of the set-up of a model [s]; default: 120")
      .within(0.1, 1e6);
  command.addFlag("--quiet,-q", options->quiet, "print nothing about files without problems");
  command.addFlag("--json", options->json, "print JSON: each problem and warning with file, line, column and key");
  command.addFlag("--files-only", options->how.files_only, "only read the files; do not set up the models of a scene");
  command.footer(
      "Each problem is one line: file:line:column: key: what is wrong, and what was expected.\nThe exit code is 2 if "
      "there is a problem. If a scene has none, its models are set up once, because only\na plugin can check some "
      "files, such as geometry. A warning names each setting that cannot be stable on\nthe device, with the bound and "
      "the nearest stable setting. If the arm is simulated, its hand then runs its\nscript once in virtual time. "
      "Warnings report a hand that touches no model, a force that is too small to feel or that\nthe limits cut, a "
      "button that does not click, and a plugin that run would silence or warn of. Warnings do not affect the exit "
      "code.\n\nExamples:\n  hapticd check "
      "config/scenes/teapot.yaml config/devices/simulated-premium15.yaml\n  hapticd check config/scenes/sphere.yaml "
      "--device my-arm.yaml\n"
      "  hapticd check --schema scene > scene.schema.json");
  command.callback([options, &exit_code] { exit_code = check(*options); });
}

}  // namespace hapticd::cli
