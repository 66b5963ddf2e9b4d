// SPDX-License-Identifier: MIT
/// Finds values of a simulated hand that no person's hand has.
#pragma once
#include "description/scene.hpp"
#include "diagnostics/hand/hand_script.hpp"
#include "diagnostics/reading/unread_keys.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of a mass, a spring, a tremor, a rate or a lead-in time that seems to be in another unit. @param unread
/// keys that could not be read; no warning depends on them
void checkHandValues(const scene::Scene& scene, const scene::Device& device, const HandScript& hand,
                     const UnreadKeys& unread, document::Problems& warnings);

}  // namespace hapticd::diagnostics
