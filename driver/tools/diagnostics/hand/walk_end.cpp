// SPDX-License-Identifier: MIT
#include "diagnostics/hand/walk_end.hpp"

#include <fmt/format.h>
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <exception>
#include <string_view>

#include "base/code_owner.hpp"
#include "diagnostics/reading/key_place.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr int kStepSeconds = 10;
constexpr const char* kEnds = "end";    ///< the process ended by itself
constexpr const char* kHangs = "hang";  ///< a step did not return

const scene::Scene* watched_scene = nullptr;
host::ChildProgress* watched_trail = nullptr;
std::terminate_handler next_terminate = nullptr;

/// Async-signal-safe.
void note(const char* call) noexcept {
  const Owner* owner = currentOwner();
  uint32_t model = 0;
  while (model < watched_scene->models.size() &&
         (owner == nullptr || owner->device || watched_scene->models[model].name != owner->name))
    ++model;
  watched_trail->mark(model, call);
}

void onCrash(int) {
  note(kEnds);  // the signal comes again, with its default action
}

void onTimer(int) {
  note(kHangs);
  _exit(1);
}

[[noreturn]] void onTerminate() {
  note(kEnds);
  next_terminate();
  _exit(1);
}

void setTimer(int seconds) noexcept {
  itimerval time{};
  time.it_value.tv_sec = seconds;
  setitimer(ITIMER_PROF, &time, nullptr);
}

}  // namespace

void noteEnd(const scene::Scene& scene, host::ChildProgress& trail) {
  watched_scene = &scene;
  watched_trail = &trail;
  trail.mark(static_cast<uint32_t>(scene.models.size()), kEnds);
  next_terminate = std::set_terminate(&onTerminate);
  struct sigaction action{};
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  action.sa_handler = &onCrash;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) sigaction(signal, &action, nullptr);
  action.sa_handler = &onTimer;
  sigaction(SIGPROF, &action, nullptr);
}

StepWatch::StepWatch() noexcept {
  setTimer(kStepSeconds);
}

StepWatch::~StepWatch() {
  setTimer(0);
}

void reportWalkEnd(const scene::Scene& scene, const std::string& how, const host::ChildProgress& trail,
                   document::Problems& warnings) {
  if (*trail.call() == '\0') return;
  const bool hangs = std::string_view(trail.call()) == kHangs;
  const uint32_t index = trail.item();
  if (index >= scene.models.size()) {
    if (!hangs)  // otherwise many models took long, and none of them is to blame
      document::report(warnings, scene.file.string(), 1, 1, "models",
                       "the hand was moved through the scene, and this process " + how);
    return;
  }
  const scene::Model& model = scene.models[index];
  const std::string key = fmt::format("models[{}].plugin", index);
  const std::string ended = hangs ? fmt::format("did not return from a step within {} s", kStepSeconds) : how;
  document::report(
      warnings, placeInModel(model, key), key,
      fmt::format("model {}: when the hand was moved, its plugin {}; a run would end there; find the cause "
                  "with: hapticd plugin check {}",
                  model.name, ended, model.library.string()));
}

}  // namespace hapticd::diagnostics
