// SPDX-License-Identifier: MIT
/// `hapticd check`: validates files, prints every problem, and warns of what cannot be stable. It also prints the JSON
/// Schema of a format.
#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <tuple>
#include <vector>

#include "cli/check_draft.hpp"
#include "cli/colour.hpp"
#include "cli/command.hpp"
#include "cli/scene_warnings.hpp"
#include "diagnostics/device_trial.hpp"
#include "diagnostics/device_warnings.hpp"
#include "diagnostics/far_paths.hpp"
#include "diagnostics/hand_path_warnings.hpp"
#include "diagnostics/hand_script.hpp"
#include "diagnostics/hand_start.hpp"
#include "diagnostics/hands_of_rest.hpp"
#include "diagnostics/key_place.hpp"
#include "diagnostics/model_file_problems.hpp"
#include "diagnostics/model_trial.hpp"
#include "diagnostics/pass_through.hpp"
#include "diagnostics/setting_plausibility.hpp"
#include "diagnostics/slow_arm.hpp"
#include "diagnostics/slow_paths.hpp"
#include "diagnostics/two_hands.hpp"
#include "diagnostics/unit_warnings.hpp"
#include "diagnostics/value_plausibility.hpp"
#include "diagnostics/velocity_warnings.hpp"
#include "document/node.hpp"
#include "document/reader.hpp"
#include "host/device_instance.hpp"
#include "host/file_stamp.hpp"
#include "scene/device_draft.hpp"
#include "tune/stability.hpp"
#include "watch/quarantine.hpp"
#include "world/arm_force.hpp"

namespace hapticd::cli {

using namespace diagnostics;
namespace {

using Json = nlohmann::ordered_json;

struct CheckArguments {
  std::vector<std::string> files;
  std::string schema, device;
  double setup_limit = kSetupSeconds;
  bool quiet = false, files_only = false, json = false;
};

int printSchema(const std::string& format) {
  std::fputs(scene::jsonSchema(format, &catalog()).c_str(), stdout);
  return kWorked;
}

/// What `check` reports about one file.
struct CheckResult {
  std::string file;
  document::Problems problems, warnings;
  bool whole = true;  ///< false if some checks were left out, because something that they need is missing or wrong
  bool hands_moved = false;    ///< true if the hands of a scene with problems were moved through its sound models
  bool hand_left_out = false;  ///< true if the scene gives a hand, but it was not moved, because of the problems
};

/// Returns true if the same key of the same file has a warning already.
bool tells(const document::Problems& told, const document::Problem& one) {
  return std::any_of(told.begin(), told.end(), [&one](const document::Problem& known) {
    return known.key == one.key && known.place.file == one.place.file && known.place.line == one.place.line;
  });
}

/// Judges the hands of a scene. Models that their plugins refuse are left out, and those whose surfaces are doubtful.
document::Problems warningsOfHands(scene::Scene full, const ModelTrial& trial, CheckResult& result) {
  std::vector<bool> refused(full.models.size()), curved(full.models.size());
  for (const document::Problem& one : result.problems)
    if (const auto model = modelOf(one.key); !model || *model >= refused.size())
      return fastHands(full);  // `run` refuses the hand, or an arm
  const std::vector<document::Problems> of_models = problemsOfModels(result.problems, refused.size());
  for (size_t i = 0; i < refused.size(); ++i) {
    curved[i] = !of_models[i].empty() && leaveOutCurves(full.models[i], i, of_models[i]);
    refused[i] = !of_models[i].empty() && !curved[i];
  }
  for (const document::Problem& one : trial.warnings)
    if (const auto model = modelOf(one.key); model && *model < refused.size() && isOfSurfaces(one))
      refused[*model] = true, curved[*model] = false;
  result.hands_moved = true;
  document::Problems warnings =
      warnOfHandsOfRest(full, trial.boxes, refused, std::vector<bool>(full.models.size(), true), catalog());
  dropOfCurves(curved, warnings);
  return warnings;
}

/// Adds warnings about settings that are allowed, but cannot be stable or are probably a mistake.
void addWarnings(const scene::Scene& full, const ModelTrial& trial, const CheckArguments& options,
                 CheckResult& result) {
  document::Problems more = unstableContacts(full, trial.stiffness);
  for (const document::Problem& one : lateVelocity(full, trial.needs_velocity)) more.push_back(one);
  for (const auto& found_by :
       {&farModels, &farPaths, &slowPaths, &softModels, &idleBounds, &quarantinedModels, &slowArms, &wideScales})
    for (const document::Problem& one : found_by(full)) more.push_back(one);
  document::Problems unread;
  if (const auto root = document::readFileOn(result.file, unread)) {
    warnOfZeros(*root, result.file, more);
    warnOfTurns(*root, result.file, more);
    warnOfMounts(*root, result.file, more);
    warnOfTwoHands(*root, result.file, more);
  }
  if (!options.files_only)
    for (const document::Problem& one : pressesThrough(full, trial.boxes)) more.push_back(one);
  if (!options.files_only)
    for (const document::Problems& found : {unreachableRows(full), warningsOfHands(full, trial, result)})
      more.insert(more.end(), found.begin(), found.end());
  if (!options.files_only || !options.device.empty())  // the warnings that a check of the device file alone gives
    for (const scene::Device& device : full.devices)
      for (const document::Problem& one : warnOfDevice(device.file, catalog()))
        // The mount is checked with the scene instead.
        if (!tells(more, one) && one.key != "mount") more.push_back(one);
  result.warnings.insert(result.warnings.end(), more.begin(), more.end());
}

/// Tries the modules of a scene's arms in child processes, before any of them is loaded here, and returns what a run
/// would refuse or where it would crash.
document::Problems badModules(const scene::Scene& scene) {
  document::Problems problems;
  for (size_t i = 0; i < scene.devices.size(); ++i) {
    const scene::Device& device = scene.devices[i];
    const ModuleTrial trial = tryModule(device);
    if (trial.error.empty()) continue;
    const document::Problems placed = tryDevice(device.file, catalog());
    problems.insert(problems.end(), placed.begin(), placed.end());
    if (!placed.empty()) continue;  // the device file itself is wrong; otherwise the scene is
    const document::Place place =
        device.place.file.empty() ? document::Place{device.file.string()} : document::Place(device.place);
    document::report(
        problems, place, "device",
        trial.error.substr(0, trial.error.find('\n')) + "; all of it: hapticd check " + device.file.string());
  }
  return problems;
}

/// Judges what could be read of a scene that has problems, so that the user sees all problems at once.
void tryTheRest(const CheckArguments& options, CheckResult& result) {
  const auto draft = scene::sceneDraft(result.file, catalog());
  result.whole = !draft && std::none_of(result.problems.begin(), result.problems.end(),
                                        [](const document::Problem& problem) { return problem.key.empty(); });
  // What was left out after a syntax error may be what another value depends on.
  if (!draft || options.files_only || document::leavesOut(result.problems, result.file)) return;
  result.hands_moved = checkDraft(*draft, result.problems, result.warnings);
  document::sortByPlace(result.problems);
}

/// Adds problems that `run` would find when it opens the arms.
void addRefusals(const scene::Scene& full, bool needs_velocity, CheckResult& result) {
  for (const document::Problems& problems :
       {refusedArms(full, needs_velocity), refusedVelocity(full, needs_velocity, result.warnings)})
    result.problems.insert(result.problems.end(), problems.begin(), problems.end());
}

/// Checks the device files of a scene with problems, with their modules and values, so that the user sees all problems
/// at once. @param named true if the devices that the scene names are used, and not the one of the option --device
void addOfDevices(CheckResult& result, bool named) {
  std::set<std::string> others;
  for (const document::Problem& one : result.problems)
    if (one.place.file != result.file) others.insert(one.place.file);
  if (const auto draft = scene::sceneDraft(result.file, catalog()); draft && named)
    for (const scene::Device& device : draft->devices) others.insert(device.file.string());
  for (const std::string& file : others) {
    document::Problems known;
    for (const document::Problem& one : result.problems)
      if (one.place.file == file) known.push_back(one);
    for (const document::Problem& one : tryDevice(file, catalog(), known))
      known.push_back(one), result.problems.push_back(one);
    if (document::leavesOut(known, file)) continue;
    for (const document::Problem& one : warnOfDevice(file, catalog(), known)) result.warnings.push_back(one);
  }
  document::sortByPlace(result.problems);
}

/// Finds the places of keys in files. Each file is read once.
class KeyPlaces {
 public:
  std::optional<document::Place> of(const std::string& file, const std::string& key) {
    document::Problems unread;
    const auto [found, is_new] = files_.try_emplace(file);
    if (is_new) found->second = document::readFileOn(file, unread);
    return found->second ? placeOfKey(*found->second, file, key) : std::nullopt;
  }

 private:
  std::map<std::string, std::optional<document::Node>> files_;
};

/// Finds the line of each warning that has only a key, or the pose of a model, and removes warnings that occur twice.
void placeWarnings(document::Problems& warnings) {
  document::Problems once;
  std::set<std::tuple<std::string, std::string, int, int, std::string>> told;
  KeyPlaces places;
  for (document::Problem& one : warnings) {
    constexpr std::string_view kPosition = ".position";
    const bool of_pose = one.key.ends_with(".pose") || one.key.ends_with(".pose.position");
    const bool of_model = one.key.starts_with("models[") && (of_pose || one.key.ends_with("].path"));
    if ((one.place.line <= 1 && one.place.column <= 1 && !one.key.empty()) || of_model) {
      auto found = places.of(one.place.file, one.key);
      if (!found && one.key.ends_with(kPosition))
        found = places.of(one.place.file, one.key.substr(0, one.key.size() - kPosition.size()));
      if (found) one.place = *found;
    }
    const bool placed = one.place.line > 1;
    if (!placed || told.emplace(one.key, one.place.file, one.place.line, one.place.column, one.what).second)
      once.push_back(std::move(one));
  }
  warnings = std::move(once);
}

/// Checks a device file, or as much as can be read of a scene that has problems.
void checkTheRest(const std::string& file, const CheckArguments& options, CheckResult& result) {
  document::Problems& found = result.problems;
  if (!found.empty()) {
    tryTheRest(options, result);
    if (!options.files_only) addOfDevices(result, true);
  }
  const document::Problems more = tryDevice(file, catalog(), found, &result.warnings);
  found.insert(found.end(), more.begin(), more.end());
  if (!document::leavesOut(found, file))
    for (const document::Problem& one : warnOfDevice(file, catalog(), found)) result.warnings.push_back(one);
  if (found.empty() && !options.files_only) found = refusedAlone(file, catalog(), result.warnings);
  document::sortByPlace(found);
}

/// Removes warnings that may only follow from text that a syntax error left out, or put into another place.
void dropWarningsThatFollow(CheckResult& result) {
  document::Problems all;
  for (const document::Problem& one : result.problems)
    if (!one.left_out.empty()) all.push_back(one);  // these are never removed
  const auto errors = static_cast<std::ptrdiff_t>(all.size());
  all.insert(all.end(), result.warnings.begin(), result.warnings.end());
  document::dropFollowUps(all);
  result.warnings.assign(all.begin() + errors, all.end());
}

CheckResult checkOne(const std::string& file, const CheckArguments& options) {
  std::optional<scene::Scene> scene;
  CheckResult result{file, scene::checkFile(file, catalog(), &scene), {}};
  document::Problems& found = result.problems;
  if (scene && !options.device.empty()) {  // the same replacement as in hapticd run --device
    scene::Loaded other = scene::load(file, catalog(), {true, options.device});
    scene = std::move(other.scene);
    found = std::move(other.problems);
    result.whole = found.empty();
    if (!scene) {
      addOfDevices(result, false);
      return result;
    }
  }
  if (scene && !options.files_only)
    if (document::Problems bad = badModules(*scene); !bad.empty()) {
      found.insert(found.end(), bad.begin(), bad.end());
      scene.reset();  // the checks of a whole scene would call these modules in this process
    }
  ModelTrial trial;
  if (scene && !options.files_only)
    trial = tryModels(*scene, servo::maxForceOf(withArm(*scene)), {}, options.setup_limit);
  found.insert(found.end(), trial.problems.begin(), trial.problems.end());
  if (scene && !options.files_only) addRefusals(withArm(*scene), trial.needs_velocity, result);
  if (!scene) checkTheRest(file, options, result);
  result.warnings.insert(result.warnings.end(), trial.warnings.begin(), trial.warnings.end());
  result.whole = result.whole && found.empty();
  if (scene) addWarnings(withArm(*scene), trial, options, result);
  if (scene) addImplausible(withArm(*scene), trial.boxes, {}, result.warnings);
  result.hand_left_out = !found.empty() && !options.files_only && placeOfKey(std::filesystem::path(file), "hand") &&
                         placeOfKey(std::filesystem::path(file), "models") && !result.hands_moved;
  placeWarnings(result.warnings);
  placeInModelFiles(result.warnings);
  separateModelFiles(result.problems);
  document::dropFollowUps(result.problems);
  dropWarningsThatFollow(result);
  return result;
}

void print(const CheckResult& result, bool quiet) {
  printProblems(result.problems, stdout);
  printWarnings(result.warnings, stdout);
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
    const CheckResult result = checkOne(file, options);
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
  if (options.json)
    std::printf(
        "%s\n",
        Json{{"problems", problems}, {"files", files}}.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
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
  command.addOption("--device", options->device,
                    "check the scenes with this device file instead of their own (as hapticd run --device)");
  command.addOption("--schema", options->schema, "print the JSON Schema of a format instead, for editors")
      .oneOf({"scene", "device", "daemon"});
  command
      .addOption("--setup-limit", options->setup_limit,
                 "longest time that a plugin may take for one call of the set-up of a model [s]; default: 120")
      .within(0.1, 1e6);
  command.addFlag("--quiet,-q", options->quiet, "print nothing about files without problems");
  command.addFlag("--json", options->json, "print JSON: each problem and warning with file, line, column and key");
  command.addFlag("--files-only", options->files_only, "only read the files; do not set up the models of a scene");
  command.footer(
      "Each problem is one line: file:line:column: key: what is wrong, and what was expected.\nThe exit code is 2 if "
      "there is a problem. If a scene has none, its models are set up once, because only\na plugin can check some "
      "files, such as geometry. A warning names each setting that cannot be stable on\nthe device, with the bound and "
      "the nearest stable setting. If the arm is simulated, its hand then runs its\nscript once in virtual time. "
      "Warnings report a hand that touches no model, a force that is too small to feel or that\nthe limits cut, a "
      "button that does not click, and a plugin that run would silence or warn of. Warnings do not affect the exit "
      "code.\n\nExample:\n  hapticd check "
      "config/scenes/teapot.yaml config/devices/simulated-premium15.yaml\n  hapticd check config/scenes/sphere.yaml "
      "--device my-arm.yaml\n  hapticd check --schema scene > "
      "scene.schema.json");
  command.callback([options, &exit_code] { exit_code = check(*options); });
}

}  // namespace hapticd::cli
