// SPDX-License-Identifier: MIT
/// Finds the model whose plugin ends a child process, in which the models of a scene are set up, or its hands move: it
/// crashes, throws an exception, ends the process, or does not return.
#pragma once
#include <string>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/child.hpp"

namespace hapticd::diagnostics {

constexpr int kStepLimitMs = 10'000;  ///< most time of one step, without the time that it waited for a processor

/// [main] Called in the child. From now on `trail` contains the model whose plugin ends the process, and the call that
/// did. Both objects must live until the process ends.
void noteEnd(const scene::Scene& scene, host::ChildProgress& trail);

/// [any] Called in the child: the hands move on, so the step before has returned.
void noteTick() noexcept;

/// The time of each tick counts as long as the object lives. noteEnd() must be called first.
class StepWatch {
 public:
  StepWatch() noexcept { noteTick(); }
  ~StepWatch();
  StepWatch(const StepWatch&) = delete;
  StepWatch& operator=(const StepWatch&) = delete;
};

/// [main] Called in the child when the hands have moved: waits a second if plugins have started threads, so that a
/// crash of such a thread comes before the end.
void letThreadsRun();

/// Returns where a plugin was at the end, such as ", in its activate()"; "" if that is unknown.
/// @param call of the trail
std::string whereAtEnd(const std::string& call);

/// [main] Called in the parent: warns of the plugin that ended the child.
/// @param how error of runInChild()
void reportWalkEnd(const scene::Scene& scene, const std::string& how, const host::ChildProgress& trail,
                   document::Problems& warnings);

}  // namespace hapticd::diagnostics
