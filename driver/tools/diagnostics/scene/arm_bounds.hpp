// SPDX-License-Identifier: MIT
/// Compares a scene with what its arms can do: the stiffness that they show without trembling, and their force.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of contacts that cannot be stable. Only simulated arms are opened, because `check` touches no hardware.
/// For a real arm the numbers of its file are used. @param stiffness [N/m] stiffness that each model claims, in scene
/// order
document::Problems unstableContacts(const scene::Scene& scene, const std::vector<double>& stiffness);

/// [main] Warns of a bound for programs (clients.max_force) above the arm's own limit, because it has no effect.
document::Problems idleBounds(const scene::Scene& scene);

/// [main] Warns of arms on which programs may push, but whose passivity controller is switched off: a program that goes
/// along with the hand then gives it energy for ever.
document::Problems unguardedPrograms(const scene::Scene& scene);
/// [main] Warns of damping that makes a knock of one count of a simulated arm; `run` warns of it for real ones.
document::Problems knocksOfDamping(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
