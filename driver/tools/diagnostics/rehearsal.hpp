// SPDX-License-Identifier: MIT
/// What a run of a scene would meet in its first seconds: simulated arms and hands go through them in virtual time.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

struct Rehearsal {
  document::Problems problems;  ///< `run` would refuse the scene
  document::Problems warnings;  ///< it would fault, cut its forces much of the time, press deep, or touch no model
};

/// [main] Runs a scene in a child process, as far as its hands go their way once, at most six seconds of the scene.
/// Only where all arms are simulated; nothing where a model crashes or hangs, which is told by who tries it alone.
/// @param scene with the devices that a run would take
Rehearsal rehearse(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
