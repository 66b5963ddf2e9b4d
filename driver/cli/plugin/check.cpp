// SPDX-License-Identifier: MIT
/// `hapticd plugin check FILE.so`: runs the conformance tests, each in a child process of its own.
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/clock.hpp"
#include "base/counted.hpp"
#include "base/shell_word.hpp"
#include "cli/plugin/file.hpp"
#include "cli/plugin/set_option.hpp"
#include "cli/support/colour.hpp"
#include "cli/support/command.hpp"
#include "conformance/building_blocks.hpp"
#include "conformance/conformance.hpp"
#include "conformance/step_watch.hpp"
#include "host/child.hpp"
#include "host/describe.hpp"

namespace hapticd::cli {

using namespace conformance;
namespace {

struct ConformanceArguments {
  std::string file;
  std::vector<std::string> set;
  bool json = false;
  double fuzz = 0, timeout = 5;
  uint64_t seed = 1;
  int limitMs(int parts = 1) const { return static_cast<int>(timeout * 1000) * parts; }
};

struct Outcome {
  std::string plugin, name;
  conformance::Verdict verdict;
  bool hung = false;
  std::string end{};  ///< how the process of the test ended, if it gave no answer

  bool failed() const { return verdict.failed(); }
  const std::string& why() const { return verdict.text; }
};

/// If a plugin that ships with hapticd needs a model file, gives it one that ships too, and prints a note.
void addModelOfOurs(const host::ClassInfo& info, Recipe& recipe) {
  const int index = info.indexOf("geometry");
  const bool ours = info.id.rfind("org.hapticd.", 0) == 0;
  if (!ours || index < 0 || givenIn(recipe.set, "geometry") != nullptr) return;
  const host::ParamInfo& param = info.params[static_cast<size_t>(index)];
  if (param.kind != HSP_PATH || (param.flags & HSP_P_REQUIRED) == 0) return;
  const bool soft = (info.flags & HSP_C_DEFORMS) != 0;
  const auto model = host::shippedFile(soft ? "models/pebble.yaml" : "models/sphere.yaml");
  if (!model) return;
  scene::Value value;
  value.id = param.id;
  value.index = static_cast<uint32_t>(index);
  value.kind = HSP_PATH;
  value.text = model->string();
  recipe.set.push_back(std::move(value));
}

/// Returns the parameters with which each class is tested; `problems` gets everything that is wrong with them.
std::vector<Recipe> recipesFor(const std::vector<host::ClassInfo>& classes, const ConformanceArguments& options,
                               std::vector<std::string>& problems) {
  SetOption set(options.set, classes);
  std::vector<Recipe> recipes;
  for (const host::ClassInfo& info : classes) {
    if (info.kind != host::Kind::kShape) {
      problems.push_back(
          options.file +
          " is a device module, expected a shape plugin; a module is examined with: hapticd device check " +
          shellWord(options.file));
      return {};
    }
    // A bare name would be looked up in the system's library folders.
    recipes.push_back({std::filesystem::absolute(options.file).string(), info.name, set.valuesFor(info), {}});
    addModelOfOurs(info, recipes.back());
    if (!set.problems().empty()) continue;  // the missing parameter may have been given under a wrong name
    for (const std::string& one : missing(info, recipes.back().set)) problems.push_back(one);
  }
  problems.insert(problems.begin(), set.problems().begin(), set.problems().end());
  return recipes;
}

/// Searches once, in a child process, for places where the shape can be touched. If the search crashes, it finds
/// nothing, and the test contact-found reports the crash. Returns an error if the shape cannot be made or activated.
Result<Touch> lookForContact(const Recipe& recipe, const ConformanceArguments& options) {
  const auto look = [&] {
    const Made made(recipe);
    return made.error.empty() ? "=" + toText(findTouch(recipe)) : made.error;
  };
  shareLastStep();
  const auto said = host::runInChild(look, options.limitMs());
  if (!said && endedBeforeSteps()) return Error{"it " + said.error() + whereItEnded()};
  if (said && said->front() != '=') return Error{*said};
  return said ? touchFromText(said->substr(1)) : Touch{};
}

Outcome tryOne(const Recipe& recipe, const ConformanceTest& test, const ConformanceArguments& options) {
  shareLastStep();
  const auto said = host::runInChild([&] { return toText(test.run(recipe, options.seed)); }, options.limitMs());
  if (said) return {recipe.class_name, test.name, verdictFromText(*said)};
  const bool hung = said.error().rfind("took longer", 0) == 0;
  return {recipe.class_name, test.name, "it " + said.error() + whereItEnded(), hung, said.error()};
}

/// Tests `count` runs with random input in one child process. @return "=" if nothing was wrong
Result<std::string> fuzzSome(const Recipe& recipe, const ConformanceArguments& options, uint64_t first, int count) {
  return host::runInChild(
      [&recipe, first, count] {
        for (uint64_t s = first; s < first + static_cast<uint64_t>(count); ++s)
          if (const std::string wrong = fuzzOnce(recipe, s); !wrong.empty())
            return "seed " + std::to_string(s) + ": " + wrong;
        return std::string("=");
      },
      options.limitMs(count));
}

/// Tests with random input until the time is over. The result names the seed of a failure, which repeats it.
Outcome fuzz(const Recipe& recipe, const ConformanceArguments& options) {
  constexpr int kRunsAChild = 20;
  const Nanoseconds end = monotonicNow() + static_cast<Nanoseconds>(options.fuzz * 1e9);
  std::string wrong;
  uint64_t seed = options.seed;
  for (; monotonicNow() < end && wrong.empty(); seed += kRunsAChild) {
    const auto said = fuzzSome(recipe, options, seed, kRunsAChild);
    if (said && *said == "=") continue;
    wrong = said ? *said : "it " + said.error();
    for (uint64_t s = seed; !said && s < seed + kRunsAChild; ++s) {
      const auto one = fuzzSome(recipe, options, s, 1);
      if (one) continue;
      wrong = "seed " + std::to_string(s) + ": it " + one.error();
      break;
    }
  }
  if (!wrong.empty()) return {recipe.class_name, "fuzz", wrong};
  return {recipe.class_name, "fuzz", noted(std::to_string(seed - options.seed) + " runs of 500 steps")};
}

/// How a kind of verdict is shown: in the table, and in JSON.
struct Shown {
  const char *word, *json;
  Colour colour;
};

Shown shown(conformance::Verdict::Kind kind) {
  switch (kind) {
    case conformance::Verdict::Kind::kPassed:
      return {"ok", "pass", Colour::kGood};
    case conformance::Verdict::Kind::kSkipped:
      return {"skip", "skip", Colour::kWarning};
    case conformance::Verdict::Kind::kWarned:
      return {"warn", "warn", Colour::kWarning};
    case conformance::Verdict::Kind::kFailed:
      break;
  }
  return {"FAIL", "fail", Colour::kBad};
}

void print(const Outcome& outcome) {
  const Shown how = shown(outcome.verdict.kind);
  std::printf("%s%-*s %-31s %s\n", coloured(how.word, how.colour).c_str(),
              static_cast<int>(5 - std::string_view(how.word).size()), "", outcome.name.c_str(), outcome.why().c_str());
  std::fflush(stdout);
}

/// Returns the outcome for a file whose classes cannot even be read: a failure of the first test.
std::vector<Outcome> unusable(const std::string& why) {
  const bool slow = why.find("took longer") != std::string::npos;
  return {{"", slow ? "scan-time-limit" : "descriptor-complete", why}};
}

/// Reports a shape that cannot be activated as a single failure, not as a failure of every test.
size_t notActive(const Recipe& recipe, const std::string& why, const ConformanceArguments& options,
                 std::vector<Outcome>& outcomes) {
  const size_t left = conformanceTests().size();
  outcomes.push_back({recipe.class_name, "activate", why});
  if (options.json) return left;
  print(outcomes.back());
  const bool crashed = endedBeforeSteps();
  std::printf("the other tests were not run: %s\n",
              crashed ? "first fix this" : "give it parameters that it accepts with --set ID=VALUE");
  return left;
}

/// The tests of one class that failed, or that were not run because others failed.
class Lacking {
 public:
  bool lacks(const ConformanceTest& test) {
    if (test.needs == nullptr || names_.count(test.needs) == 0) return false;
    names_.insert(test.name);
    if (cause_.empty()) cause_ = test.needs;
    ++not_run_;
    return true;
  }
  void add(const Outcome& failed) { names_.insert(failed.name); }
  void addCause(const Outcome& failed) { add(failed), cause_ = failed.name; }
  size_t notRun() const { return not_run_; }
  const std::string& cause() const { return cause_; }

 private:
  std::set<std::string> names_;
  std::string cause_;
  size_t not_run_ = 0;
};

/// Tests whose processes end in the same way have one cause. It is reported once, and the other tests are only listed.
class SameEnd {
 public:
  bool known(const Outcome& outcome) {
    if (outcome.end.empty()) return false;
    std::vector<std::string>& names = tests_[outcome.end];
    names.push_back(outcome.name);
    return names.size() > 1;
  }
  void print() const {
    for (const auto& [end, names] : tests_) {
      if (names.size() < 2) continue;
      std::printf("and %zu other %s: it %s:", names.size() - 1, names.size() == 2 ? "test" : "tests", end.c_str());
      for (size_t i = 1; i < names.size(); ++i) std::printf("%s %s", i > 1 ? "," : "", names[i].c_str());
      std::printf("\n");
    }
  }

 private:
  std::map<std::string, std::vector<std::string>> tests_;
};

/// If a plugin writes beyond its memory, any later test may crash. So after a crash the test in guarded memory is run,
/// which tells what was overrun. @return its outcome if it found an overrun, which is then named as the cause in
/// `crashed`
std::optional<Outcome> overrunBehind(const Recipe& recipe, const ConformanceArguments& options, Outcome& crashed) {
  if (crashed.end.empty() || crashed.hung || crashed.name == kGuarded) return std::nullopt;
  for (const ConformanceTest& test : conformanceTests()) {
    if (test.name != std::string_view(kGuarded)) continue;
    Outcome guarded = tryOne(recipe, test, options);
    const bool named = overran() || guarded.why().find(kBeyond) != std::string::npos;
    if (!guarded.failed() || guarded.hung || !named) return std::nullopt;
    crashed.verdict.text +=
        ": it wrote or read memory that is not its own; first correct what fails in " + std::string(kGuarded);
    return guarded;
  }
  return std::nullopt;
}

/// Runs the tests of one class. Stops after the first test that hangs, because later tests would hang too. A test that
/// needs a failed test is left out, because it would fail for the same reason. @return how many tests were not run
size_t testClass(const Recipe& recipe, const ConformanceArguments& options, std::vector<Outcome>& outcomes) {
  const auto& tests = conformanceTests();
  Lacking lacking;
  SameEnd same;
  std::optional<Outcome> guarded;
  bool told = false;
  size_t left = 0;
  for (size_t i = 0; i < tests.size() && left == 0; ++i) {
    if (lacking.lacks(tests[i])) continue;
    if (guarded && tests[i].name == std::string_view(kGuarded)) continue;
    outcomes.push_back(tryOne(recipe, tests[i], options));
    if (!guarded) guarded = overrunBehind(recipe, options, outcomes.back());
    if (outcomes.back().failed()) lacking.add(outcomes.back());
    const bool hung = outcomes.back().hung;
    if (!same.known(outcomes.back()) && !options.json) print(outcomes.back());
    if (guarded && !told) {
      lacking.addCause(*guarded), outcomes.push_back(*guarded), told = true;
      if (!options.json) print(outcomes.back());
    }
    if (hung) left = tests.size() - i - 1;
  }
  if (!options.json) {
    same.print();
    if (left > 0)
      std::printf("stopped at the first hang: %zu tests were not run; if the plugin is only slow: --timeout SECONDS\n",
                  left);
    if (lacking.notRun() > 0)
      std::printf("%zu other %s not run: first fix %s\n", lacking.notRun(),
                  lacking.notRun() == 1 ? "test was" : "tests were", lacking.cause().c_str());
  }
  if (options.fuzz > 0 && left + lacking.notRun() == 0) {
    outcomes.push_back(fuzz(recipe, options));
    if (!options.json) print(outcomes.back());
  }
  return left + lacking.notRun();
}

/// Says which arrays no test used, because they are empty by default.
void printUntested(const std::vector<EmptyArray>& arrays) {
  for (const EmptyArray& array : arrays)
    std::printf("note  %s is empty by default, so no test used it; test it too, with values of yours: --set %s\n",
                array.id.c_str(), array.set.c_str());
}

int sum(const std::vector<Outcome>& outcomes, size_t not_run, const ConformanceArguments& options) {
  size_t failed = 0;
  auto tests = nlohmann::ordered_json::array();
  for (const Outcome& o : outcomes) {
    failed += o.failed() ? 1 : 0;
    const char* result = shown(o.verdict.kind).json;
    tests.push_back({{"plugin", o.plugin}, {"name", o.name}, {"result", result}, {"why", o.why()}});
  }
  const nlohmann::ordered_json all{
      {"file", options.file}, {"seed", options.seed}, {"failed", failed}, {"not_run", not_run}, {"tests", tests}};
  if (options.json)
    printJson(all);
  else
    std::printf("%s, %zu failed%s\n", counted(outcomes.size(), "test").c_str(), failed,
                not_run > 0 ? (", " + std::to_string(not_run) + " not run").c_str() : "");
  return failed == 0 ? kWorked : kFailed;
}

int check(const ConformanceArguments& options) {
  if (const std::string why = whyNoPlugin(options.file); !why.empty()) return fail(kBadInput, why);
  std::vector<Outcome> outcomes;
  const auto classes = host::describeInChild(options.file);
  if (!classes) outcomes = unusable(classes.error());
  if (classes && classes->empty()) outcomes = unusable("the file holds no shape class");
  if (!options.json && !outcomes.empty()) print(outcomes.front());
  std::vector<std::string> problems;
  std::vector<Recipe> recipes;
  if (classes) recipes = recipesFor(*classes, options, problems);
  for (const std::string& problem : problems) fail(kBadInput, problem);
  if (!problems.empty()) return kBadInput;
  size_t not_run = 0;
  for (size_t i = 0; i < recipes.size(); ++i) {
    const host::ClassInfo& info = (*classes)[i];
    if (!options.json) std::printf("%s %s (%s)\n", info.name.c_str(), info.version.c_str(), info.id.c_str());
    auto touch = lookForContact(recipes[i], options);
    if (touch) recipes[i].touch = *touch;
    not_run +=
        touch ? testClass(recipes[i], options, outcomes) : notActive(recipes[i], touch.error(), options, outcomes);
    if (!options.json) printUntested(emptyArrays(info, recipes[i].set));
  }
  return sum(outcomes, not_run, options);
}

}  // namespace

void addPluginCheck(const Command& app, int& exit_code) {
  auto options = std::make_shared<ConformanceArguments>();
  const Command command = app.subcommand("plugin").addSubcommand(
      "check", "Run the conformance tests of a plugin file, each in its own process.");
  command.addOption("file", options->file, "plugin file (.so)").required();
  command
      .addOption("--set", options->set,
                 "set a parameter, required or not: ID=VALUE, VALUE as in a scene; may be repeated; without it the "
                 "tests use the defaults")
      .oneValueEach();
  command.addOption("--timeout", options->timeout, "longest time of one test [s]; a longer one counts as a hang")
      .showDefault()
      .within(0.1, 3600.0);
  command.addFlag("--json", options->json, "print the results as JSON");
  command.addOption("--fuzz", options->fuzz, "after the tests, try random parameters and probes for this time [s]")
      .within(0.0, 1e6);
  command.addOption("--seed", options->seed, "seed of all random numbers; a failure names the seed that repeats it")
      .showDefault();
  command.footer(
      "The exit code is 1 if a test fails, 2 if a parameter is wrong. If a test hangs, the tests after it are not "
      "run.\n\n"
      "Examples:\n  hapticd plugin check ./my_shape.so --fuzz 60 --seed 7\n"
      "  hapticd plugin check ./relief.so --set heights=hills.csv --set 'origin=[0, 0.1, 0]'");
  command.callback([options, &exit_code] { exit_code = check(*options); });
}

}  // namespace hapticd::cli
