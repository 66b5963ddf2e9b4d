// SPDX-License-Identifier: MIT
/// `hapticd replay`: runs a recording again and says where it first differs.
#include "session/replay/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "cli/recording/replayed_forces.hpp"
#include "cli/support/command.hpp"
#include "cli/support/guarded_command.hpp"
#include "cli/support/open_end.hpp"
#include "cli/support/output_file.hpp"
#include "cli/support/tick_watch.hpp"
#include "document/node.hpp"
#include "document/suggestion.hpp"
#include "record/recording.hpp"
#include "world/instructions.hpp"

namespace hapticd::cli {

namespace {

constexpr int kPartly = 3;  ///< exit code: what was replayed is the same, but not all can be replayed

using Json = nlohmann::ordered_json;

struct ReplayArguments {
  std::string file;
  std::vector<std::string> changes;
  std::string csv;
  bool json = false;
};

Result<void> findLibrary(scene::Model& model) {
  auto found = catalog().shape(model.plugin);
  if (!found) return Error{"model '" + model.name + "': " + found.error()};
  model.library = (*found)->file;
  return {};
}

/// Finds plugins and modules on this machine, because the recording may come from another one. The replay ends where a
/// model came whose plugin is missing.
Result<void> findLibraries(servo::RecordedRun& run) {
  for (scene::Model& model : run.scene.models)
    if (auto found = findLibrary(model); !found) return found;
  for (servo::RunModel& one : run.later)
    if (auto found = one.lack.empty() ? findLibrary(one.model) : Result<void>(); !found) one.lack = found.error();
  for (scene::Device& device : run.scene.devices) {
    auto found = catalog().device(device.module);
    if (!found) return Error{"device '" + device.name + "': " + found.error()};
    device.library = (*found)->file;
  }
  return {};
}

constexpr const char* kForm = "expected MODEL.PARAMETER=NUMBER";

/// The models of the scene, and those that came later and can be replayed.
std::vector<scene::Model*> modelsOf(servo::RecordedRun& run) {
  std::vector<scene::Model*> models;
  for (scene::Model& model : run.scene.models) models.push_back(&model);
  for (servo::RunModel& one : run.later)
    if (one.lack.empty()) models.push_back(&one.model);
  return models;
}

using Models = std::vector<scene::Model*>;

/// Returns "; did you mean ball.stiffness=3?" with the first model that has the parameter of "stiffness=3"; "" if none
/// has it.
std::string meantModel(const Models& models, const std::string& text) {
  const std::string id = text.substr(0, text.find('='));
  for (const scene::Model* model : models)
    if (auto found = catalog().shape(model->plugin); found && (*found)->indexOf(id) >= 0)
      return "; did you mean " + model->name + "." + text + "?";
  return "";
}

/// Returns what is wrong with a change as a text, such as "teapot.stiffness900"; "" if nothing is.
std::string wrongForm(const Models& models, const std::string& text) {
  const size_t equals = text.find('='), dot = text.find('.');
  if (equals == std::string::npos) return std::string("no value is given, ") + kForm;
  if (dot == std::string::npos || dot > equals)
    return std::string("no model is named, ") + kForm + meantModel(models, text);
  const std::string value = text.substr(equals + 1);
  return document::toNumber(value) ? "" : "\"" + value + "\" is not a number, " + kForm;
}

/// The names, each one once: after a reload, a later model has the name of one of the scene.
std::vector<std::string> namesOf(const Models& models) {
  std::vector<std::string> names;
  for (const scene::Model* model : models)
    if (std::find(names.begin(), names.end(), model->name) == names.end()) names.push_back(model->name);
  return names;
}

/// Applies a change such as "teapot.stiffness=900" to the parameter of one model.
Result<void> changeModel(scene::Model& model, const std::string& id, double number, const std::string& text) {
  auto found = catalog().shape(model.plugin);
  const int index = found ? (*found)->indexOf(id) : -1;
  if (index < 0)
    return Error{"--set " + text + ": plugin " + model.plugin + " has no parameter \"" + id + "\"" +
                 (found ? document::suggestionOfName(id, (*found)->paramIds()) : "")};
  const host::ParamInfo& param = (*found)->params[static_cast<size_t>(index)];
  const bool is_number = param.kind >= HSP_REAL && param.kind <= HSP_ENUM;
  if (!is_number) return Error{"--set " + text + ": \"" + id + "\" has no number that could be changed"};
  if (!(number >= param.min && number <= param.max))
    return Error{fmt::format("--set {}: {:g} is out of range, expected {:g} to {:g} {}", text, number, param.min,
                             param.max, param.unit)};
  const auto same = [&](const scene::Value& v) { return v.index == static_cast<uint32_t>(index); };
  auto value = std::find_if(model.parameters.begin(), model.parameters.end(), same);
  if (value == model.parameters.end()) value = model.parameters.insert(value, scene::Value{});
  value->id = id;
  value->index = static_cast<uint32_t>(index);
  value->kind = param.kind;
  value->number = number;
  return {};
}

/// Parses a change such as "teapot.stiffness=900" and applies it to all models of that name.
Result<void> change(const Models& models, const std::string& text) {
  if (const std::string wrong = wrongForm(models, text); !wrong.empty()) return Error{"--set " + text + ": " + wrong};
  const size_t equals = text.find('='), dot = text.find('.');
  const double number = document::toNumber(text.substr(equals + 1)).value_or(NAN);  // wrongForm() has checked it
  const std::string name = text.substr(0, dot), id = text.substr(dot + 1, equals - dot - 1);
  const std::vector<std::string> names = namesOf(models);
  if (std::find(names.begin(), names.end(), name) == names.end())
    return Error{"--set " + text + ": the recording has no model \"" + name + "\", expected one of " +
                 document::listedFor(name, names) + document::suggestionOfName(name, names)};
  for (scene::Model* model : models)
    if (model->name == name)
      if (auto changed = changeModel(*model, id, number, text); !changed) return changed;
  return {};
}

void warnOfChanges(const servo::RecordedRun& run) {
  if (run.version != HAPTICD_VERSION)
    std::fprintf(stderr, "warning: hapticd %s recorded this run, and this is hapticd %s: the results may differ\n",
                 run.version.c_str(), HAPTICD_VERSION);
  std::vector<servo::Fingerprint> files = run.files;
  for (const servo::RunModel& one : run.later) files.insert(files.end(), one.files.begin(), one.files.end());
  std::map<std::string, std::string> now;
  std::set<std::string> changed;
  for (const servo::Fingerprint& file : files) {
    const auto [found, is_new] = now.try_emplace(file.path);
    if (is_new) found->second = servo::fingerprint(file.path);
    if (!found->second.empty() && found->second != file.hash) changed.insert(file.path);
  }
  for (const std::string& path : changed)
    std::fprintf(stderr, "warning: %s has changed since the recording, so the results may differ\n", path.c_str());
}

/// Uses the processor instructions of the recorded run if this machine has them; otherwise prints a note.
void takeInstructions(servo::RecordedRun& run) {
  if (run.instructions.empty()) return;
  if (run.instructions == "portable") run.scene.servo.instructions = scene::Instructions::kPortable;
  if (const std::string now = servo::takenInstructions(run.scene.servo); now != run.instructions)
    std::fprintf(
        stderr,
        "note: the run used the processor instructions %s, which are not available here: the last bits will differ\n"
        "  fix: record with servo: {instructions: portable}, which replays on every machine\n",
        run.instructions.c_str());
}

int verdictOf(const servo::ReplayOutcome& outcome) {
  if (outcome.first) return kFailed;
  if (outcome.ticks == outcome.recorded_ticks) return kWorked;
  return outcome.note.empty() ? kFailed : kPartly;
}

int print(const servo::ReplayOutcome& outcome) {
  if (!outcome.note.empty()) std::fprintf(stderr, "note: %s\n", outcome.note.c_str());
  if (!outcome.first) {
    std::printf("%llu ticks of %llu: every bit is the same\n", static_cast<unsigned long long>(outcome.ticks),
                static_cast<unsigned long long>(outcome.recorded_ticks));
    return verdictOf(outcome);
  }
  const servo::Difference& first = *outcome.first;
  std::printf("the first difference is in tick %llu (t = %.6f s): %s was %.17g, is now %.17g\n",
              static_cast<unsigned long long>(first.tick), first.t, first.what.c_str(), first.recorded, first.replayed);
  std::printf("largest difference of the sent force: %.3g N in %llu ticks\n", outcome.largest_force_error,
              static_cast<unsigned long long>(outcome.ticks));
  return verdictOf(outcome);
}

int printAsJson(const servo::ReplayOutcome& outcome) {
  Json json{{"same", !outcome.first.has_value()},
            {"ticks", outcome.ticks},
            {"recorded_ticks", outcome.recorded_ticks},
            {"note", outcome.note.empty() ? Json() : Json(outcome.note)},
            {"first_difference", nullptr},
            {"largest_force_error_n", outcome.largest_force_error}};
  if (const auto& first = outcome.first)
    json["first_difference"] = {{"tick", first->tick},
                                {"t", first->t},
                                {"what", first->what},
                                {"recorded", first->recorded},
                                {"replayed", first->replayed}};
  printJson(json);
  return verdictOf(outcome);
}

/// Replays, and writes the table that was asked for.
Result<servo::ReplayOutcome> replayInto(const std::string& csv, servo::Replay& again, const record::Recording& of) {
  if (csv.empty()) return again.run();
  const auto table = ReplayedForces::open(csv, *of.stream("ticks"));
  if (!table) return Error{table.error()};
  servo::ReplayOutcome outcome =
      again.run([&](const std::byte* recorded, const std::byte* replayed) { (*table)->write(recorded, replayed); });
  if (auto whole = (*table)->close(); !whole) return Error{whole.error()};
  return outcome;
}

/// Returns why the table must not be written, or "".
std::string wrongTable(const ReplayArguments& options) {
  OutputKind kind = tableKind(ReplayedForces::kFirstColumns);
  kind.file_only = true;  // standard output has the outcome
  const std::string kept = whyNotWritten(options.csv, kind, {{options.file, "the recording"}});
  return kept.empty() ? whyNotWritable(options.csv) : kept;
}

int replay(const ReplayArguments& options) {
  if (const std::string wrong = wrongTable(options); !wrong.empty()) return fail(kBadInput, wrong);
  auto recording = record::Recording::open(options.file);
  if (!recording) return fail(kBadInput, recording.error());
  auto run = servo::readAbout((*recording)->aboutJson());
  if (!run) return fail(kBadInput, options.file + ": " + run.error());
  run->later = servo::RunModels(**recording, run->scene).later();
  if (auto found = findLibraries(*run); !found) return fail(kBadInput, options.file + ": " + found.error());
  for (const std::string& text : options.changes)
    if (auto done = change(modelsOf(*run), text); !done) return fail(kBadInput, done.error());
  takeInstructions(*run);
  warnOfChanges(*run);
  noteOpenEnd(options.file, **recording, "replaying");
  const GuardedCommand guarded;
  const TickWatch watched;
  const SetupErrors once;
  const std::string& damage = (*recording)->damage();
  auto again = servo::Replay::prepare(**recording, *run, logToTerminal);
  if (!again)
    return fail(kBadInput, options.file + ": " + again.error() + (damage.empty() ? "" : ", because " + damage));
  auto replayed = replayInto(options.csv, **again, **recording);
  if (!replayed) return fail(kFailed, replayed.error());
  servo::ReplayOutcome outcome = *replayed;
  if (auto same = (*recording)->unchanged(); !same) return fail(kFailed, same.error());
  if (!damage.empty()) outcome.note += (outcome.note.empty() ? "" : "; ") + damage;
  const int code = options.json ? printAsJson(outcome) : print(outcome);
  return code == kWorked && !damage.empty() ? kPartly : code;
}

}  // namespace

void addReplay(const Command& app, int& exit_code) {
  auto options = std::make_shared<ReplayArguments>();
  const Command command = app.addSubcommand("replay", "Run a recording again and compare every force to the last bit.");
  command.addOption("file", options->file, "recording made by `hapticd run --record`").required();
  command.addOption("--set", options->changes, "change a parameter: MODEL.PARAMETER=NUMBER; may be repeated");
  command.addOption("--csv", options->csv,
                    "write depth and sent force of each tick, recorded and replayed, to this table [m, N]");
  command.addFlag("--json", options->json, "print the outcome as JSON");
  command.footer(
      "Exit codes: 0 every bit is the same, 1 something differs, 2 the recording cannot be replayed, 3 every bit is "
      "the same\nas far as the run could be replayed: a replay ends where a model was added that cannot be built, or "
      "where the file is damaged.\n\nExample:\n  "
      "hapticd run config/scenes/teapot.yaml --for 10 --record run.h5\n  hapticd replay run.h5\n  hapticd replay "
      "run.h5 --set teapot.stiffness=900 --csv both.csv");
  setGuardedCallback(command, exit_code, [options] { return replay(*options); });
}

}  // namespace hapticd::cli
