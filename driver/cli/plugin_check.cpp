// SPDX-License-Identifier: MIT
/// `hapticd plugin check FILE.so`: the conformance tests, each in a child process of its own.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "cli/command.hpp"
#include "conformance/conformance.hpp"
#include "host/child.hpp"
#include "host/describe.hpp"

namespace hapticd::cli {

using namespace conformance;
namespace {

constexpr int kLimitMs = 120'000;

struct Options {
  std::string file;
  std::vector<std::string> set;
  bool json = false;
  double fuzz = 0;
  uint64_t seed = 1;
};

struct Outcome {
  std::string plugin, name, why;
  bool passed = false, skipped = false;
};

/// A plugin that must be given a model gets one of ours.
Result<Recipe> recipeFor(const host::ClassInfo& info, const Options& options) {
  Recipe recipe{options.file, info.name, {}};
  for (const std::string& pair : options.set) {
    const size_t equals = pair.find('=');
    if (equals == std::string::npos) return Error{"--set " + pair + ": expected id=value"};
    recipe.set[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  for (const host::ParamInfo& param : info.params) {
    if ((param.flags & HSP_P_REQUIRED) == 0 || recipe.set.count(param.id) > 0) continue;
    const bool soft = (info.flags & HSP_C_DEFORMS) != 0;
    const auto model = host::shippedFile(soft ? "models/pebble.yaml" : "models/sphere.yaml");
    if (param.kind != HSP_PATH || !model)
      return Error{"plugin '" + info.name + "' requires the parameter '" + param.id + "'; give it with --set " +
                   param.id + "=VALUE"};
    recipe.set[param.id] = model->string();
  }
  return recipe;
}

Outcome tryOne(const Recipe& recipe, const ConformanceTest& test, uint64_t seed) {
  Outcome outcome{recipe.class_name, test.name, "", false, false};
  const auto said = host::runInChild([&] { return "=" + test.run(recipe, seed); }, kLimitMs);
  outcome.why = said ? said->substr(1) : "it " + said.error();
  outcome.skipped = outcome.why.rfind("skip: ", 0) == 0;
  outcome.passed = outcome.why.empty() || outcome.skipped;
  if (outcome.skipped) outcome.why.erase(0, 6);
  return outcome;
}

/// Runs of random input until the time is over; the seed of a failure repeats it.
Outcome fuzz(const Recipe& recipe, const Options& options) {
  constexpr uint64_t kRunsAChild = 20;
  const Nanoseconds end = monotonicNow() + static_cast<Nanoseconds>(options.fuzz * 1e9);
  Outcome outcome{recipe.class_name, "fuzz", "", true, false};
  uint64_t seed = options.seed;
  for (; monotonicNow() < end && outcome.passed; seed += kRunsAChild) {
    const auto many = [&](uint64_t first, uint64_t count) {
      return host::runInChild(
          [&recipe, first, count] {
            for (uint64_t s = first; s < first + count; ++s)
              if (const std::string wrong = fuzzOnce(recipe, s); !wrong.empty())
                return "seed " + std::to_string(s) + ": " + wrong;
            return std::string("=");
          },
          kLimitMs);
    };
    const auto said = many(seed, kRunsAChild);
    if (said && *said == "=") continue;
    outcome.passed = false;
    outcome.why = said ? *said : "it " + said.error();
    for (uint64_t s = seed; !said && s < seed + kRunsAChild; ++s)
      if (!many(s, 1)) outcome.why = "seed " + std::to_string(s) + ": it " + many(s, 1).error();
  }
  if (outcome.passed) outcome.why = std::to_string(seed - options.seed) + " runs of 500 steps";
  return outcome;
}

void print(const Outcome& outcome) {
  std::printf("%-5s %-31s %s\n",
              outcome.skipped  ? "skip"
              : outcome.passed ? "ok"
                               : "FAIL",
              outcome.name.c_str(), outcome.why.c_str());
  std::fflush(stdout);
}

/// A file that cannot even be described fails by the name of the test that says so.
std::vector<Outcome> unusable(const std::string& why) {
  const bool slow = why.find("took longer") != std::string::npos;
  return {{"", slow ? "scan-time-limit" : "descriptor-complete", why, false, false}};
}

int check(const Options& options) {
  std::vector<Outcome> outcomes;
  const auto classes = host::describeInChild(options.file);
  if (!classes) outcomes = unusable(classes.error());
  if (classes && classes->empty()) outcomes = unusable("the file holds no shape class");
  if (!options.json && !outcomes.empty()) print(outcomes.front());
  for (size_t i = 0; classes && i < classes->size(); ++i) {
    const host::ClassInfo& info = (*classes)[i];
    if (info.kind != host::Kind::kShape)
      return fail(kBadInput, options.file + " is a device module, expected a shape plugin");
    const auto recipe = recipeFor(info, options);
    if (!recipe) return fail(kBadInput, recipe.error());
    if (!options.json) std::printf("%s %s (%s)\n", info.name.c_str(), info.version.c_str(), info.id.c_str());
    for (const ConformanceTest& test : conformanceTests()) {
      outcomes.push_back(tryOne(*recipe, test, options.seed));
      if (!options.json) print(outcomes.back());
    }
    if (options.fuzz <= 0) continue;
    outcomes.push_back(fuzz(*recipe, options));
    if (!options.json) print(outcomes.back());
  }
  size_t failed = 0;
  auto tests = nlohmann::ordered_json::array();
  for (const Outcome& o : outcomes) {
    failed += o.passed ? 0 : 1;
    tests.push_back({{"plugin", o.plugin},
                     {"name", o.name},
                     {"result", o.skipped  ? "skip"
                                : o.passed ? "pass"
                                           : "fail"},
                     {"why", o.why}});
  }
  if (options.json)
    std::printf(
        "%s\n",
        nlohmann::ordered_json{{"file", options.file}, {"seed", options.seed}, {"failed", failed}, {"tests", tests}}
            .dump(2)
            .c_str());
  else
    std::printf("%zu tests, %zu failed\n", outcomes.size(), failed);
  return failed == 0 ? kWorked : kFailed;
}

}  // namespace

void addPluginCheck(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.get_subcommand("plugin")->add_subcommand(
      "check", "Run the conformance tests of a plugin file, each in its own process.");
  command->add_option("file", options->file, "plugin file (.so)")->required()->check(CLI::ExistingFile);
  command->add_option("--set", options->set, "set a parameter: ID=VALUE; may be repeated");
  command->add_flag("--json", options->json, "print the results as JSON");
  command->add_option("--fuzz", options->fuzz, "after the tests, try random parameters and probes for this time [s]")
      ->check(within(0.0, 1e6));
  command->add_option("--seed", options->seed, "seed of all random numbers; a failure names the seed that repeats it")
      ->capture_default_str();
  command->footer(
      "The exit code is 1 if a test fails.\n\nExample:\n  hapticd plugin check ./my_shape.so --fuzz 60 --seed 7");
  command->callback([options, &exit_code] { exit_code = check(*options); });
}

}  // namespace hapticd::cli
