// SPDX-License-Identifier: MIT
/// Finds the model whose plugin ends a child process in which the hands of a scene move: it crashes, throws an
/// exception, or does not return from a step.
#pragma once
#include <string>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/child.hpp"

namespace hapticd::diagnostics {

/// [main] Called in the child. From now on `trail` contains the model whose plugin ends the process. Both objects must
/// live until the process ends.
void noteEnd(const scene::Scene& scene, host::ChildProgress& trail);

/// Ends the process if the steps of the object's life take more than 10 s of processor time. noteEnd() must be called
/// first.
class StepWatch {
 public:
  StepWatch() noexcept;
  ~StepWatch();
  StepWatch(const StepWatch&) = delete;
  StepWatch& operator=(const StepWatch&) = delete;
};

/// [main] Called in the parent: warns of the plugin that ended the child.
/// @param how error of runInChild()
void reportWalkEnd(const scene::Scene& scene, const std::string& how, const host::ChildProgress& trail,
                   document::Problems& warnings);

}  // namespace hapticd::diagnostics
