// SPDX-License-Identifier: MIT
/// Finds values of a simulated hand that no person's hand has.
#pragma once
#include "description/scene.hpp"
#include "diagnostics/hand_script.hpp"
#include "diagnostics/unread_keys.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of a mass, a spring, a tremor, a rate or a lead-in that was meant in another unit. @param unread keys
/// with problems, on which no judgement depends
void checkHandValues(const scene::Scene& scene, const scene::Device& device, const HandScript& hand,
                     const UnreadKeys& unread, document::Problems& warnings);

}  // namespace hapticd::diagnostics
