// SPDX-License-Identifier: MIT
#include "diagnostics/scene/trial_end.hpp"

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iterator>
#include <set>
#include <thread>
#include <vector>

#include "base/call_name.hpp"
#include "base/code_owner.hpp"
#include "base/os.hpp"
#include "base/shell_word.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "host/catalog.hpp"
#include "watch/culprit.hpp"
#include "watch/process_end.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr const char* kThread = "a thread";         ///< a thread that the plugin had started
constexpr const char* kDestructor = "destructors";  ///< after the answer

const scene::Scene* watched_scene = nullptr;
host::ChildProgress* watched_trail = nullptr;
std::terminate_handler next_terminate = nullptr;

/// Notes the plugin that ends the process; nullptr if it is unknown. Async-signal-safe.
void note(const Owner* owner) noexcept {
  if (owner == nullptr || owner->device) return;
  uint32_t model = 0;
  while (model < watched_scene->models.size() && watched_scene->models[model].name != owner->name) ++model;
  const char* call = callNameHere() != nullptr ? callNameHere() : "step";
  if (currentOwner() == nullptr) call = isWorker() ? "step" : kThread;
  watched_trail->mark(model, watched_trail->answered() ? kDestructor : call);
}

void onCrash(int signal, siginfo_t* info, void* context) {
  const Owner* culprit = watch::blameFor(signal, *info, context).culprit;
  // After the answer only destructors run, and they are nobody's call.
  note(culprit == nullptr && watched_trail->answered() ? interruptedOwner(context) : culprit);
  // the signal comes again, with its default action
}

/// The parent sends this signal if the process takes too long.
void onLate(int) {
  note(ownerOfWorker(Worker::kMain));
  watch::endProcess(1);
}

void onExit() {
  const Owner* culprit = currentOwner();
  note(culprit == nullptr && !isWorker() ? ownerOnStack(__builtin_frame_address(0)) : culprit);
}

[[noreturn]] void onTerminate() {
  note(currentOwner());
  next_terminate();
  watch::endProcess(1);
}

/// Returns the index of the first model of each plugin that does not come with hapticd.
std::vector<size_t> foreignPlugins(const scene::Scene& scene) {
  std::vector<size_t> found;
  std::set<std::filesystem::path> known;
  for (size_t i = 0; i < scene.models.size(); ++i)
    if (const scene::Model& model = scene.models[i]; !host::ships(model.library) && known.insert(model.library).second)
      found.push_back(i);
  return found;
}

/// Warns of the end of a walk that no plugin is known to have caused. If only one plugin does not come with hapticd, it
/// is the likely cause.
void reportUnknownEnd(const scene::Scene& scene, const std::string& how, document::Problems& warnings) {
  document::Place place{scene.file.string(), 1, 1};
  std::string key = "models", likely;
  const std::vector<size_t> foreign = foreignPlugins(scene);
  for (const size_t index : foreign) {
    const scene::Model& model = scene.models[index];
    likely += fmt::format("{}plugin '{}' of model {} (hapticd plugin check {})", likely.empty() ? "" : " or ",
                          model.plugin, model.name, shellWord(model.library.string()));
    if (foreign.size() > 1) continue;
    key = fmt::format("models[{}].plugin", index);
    place = placeInModel(model, key);
  }
  const std::string cause = foreign.empty()
                                ? "which plugin did that is not known; hapticd run --virtual-time may name it"
                                : "the likely cause does not come with hapticd: " + likely;
  document::report(
      warnings, place, key,
      "the process in which check moves the hand " + how + ", so what the hand meets was not judged; " + cause);
}

}  // namespace

void noteEnd(const scene::Scene& scene, host::ChildProgress& trail) {
  // Lives until the process ends, because the signals may come until then.
  static const WorkerScope& working = *new WorkerScope(Worker::kMain);
  (void)working;
  watched_scene = &scene;
  watched_trail = &trail;
  trail.mark(static_cast<uint32_t>(scene.models.size()), "");
  os::prepareSignalStack();  // for a stack that is full
  watch::prepareBlame();
  next_terminate = std::set_terminate(&onTerminate);
  struct sigaction action{};
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_SIGINFO | SA_ONSTACK);
  action.sa_sigaction = &onCrash;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) sigaction(signal, &action, nullptr);
  action.sa_flags = 0;
  action.sa_handler = &onLate;
  sigaction(SIGPROF, &action, nullptr);
  if (std::atexit(&onExit) == 0) std::at_quick_exit(&onExit);
  watch::onPlainExit(&onExit);
}

void noteTick() noexcept {
  if (watched_trail != nullptr) watched_trail->beginPiece();
}

StepWatch::~StepWatch() {
  watched_trail->rest();
}

void letThreadsRun() {
  constexpr auto kPatience = std::chrono::seconds(1);
  std::error_code error;
  const std::filesystem::directory_iterator threads("/proc/self/task", error);
  if (!error && std::distance(begin(threads), end(threads)) > 1) std::this_thread::sleep_for(kPatience);
}

std::string whereAtEnd(const std::string& call) {
  if (call.empty()) return "";
  if (call == kThread) return ", in a thread that it had started";
  if (call == kDestructor) return ", in a destructor of one of its static objects";
  return ", in its " + call + "()";
}

void reportWalkEnd(const scene::Scene& scene, const std::string& how, const host::ChildProgress& trail,
                   document::Problems& warnings) {
  const uint32_t index = trail.item();
  const bool known = index < scene.models.size();
  if (how.starts_with("took longer"))  // everything together did, so the last model is perhaps not to blame
    return document::report(
        warnings, scene.file.string(), 1, 1, "models",
        "what the hand meets was not judged, because setting up the models and moving it " + how +
            (known ? "; the last call was " + std::string(trail.call()) + "() of model " + scene.models[index].name
                   : ""));
  if (!known) return reportUnknownEnd(scene, how, warnings);
  const scene::Model& model = scene.models[index];
  reportInModel(warnings, scene, index, "plugin",
                fmt::format("model {}: when the hand was moved, its plugin {}{}; a run would end there; find the cause "
                            "with: hapticd plugin check {}",
                            model.name, how, whereAtEnd(trail.call()), shellWord(model.library.string())));
}

}  // namespace hapticd::diagnostics
