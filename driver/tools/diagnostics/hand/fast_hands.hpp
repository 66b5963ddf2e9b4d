// SPDX-License-Identifier: MIT
/// Warns of simulated hands that move unlike human hands.
#pragma once
#include "description/scene.hpp"
#include "diagnostics/reading/unread_keys.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

inline constexpr double kFastestHand = 2;  ///< [m/s] greatest speed of a human hand that strokes, presses or taps

/// [main] Warns of strokes of more than half a turn to either side, which seem to be in degrees; of a hand that is
/// faster than human hands; of a path that is so slow that its times seem not to be in s; and of values that no hand
/// has.
/// @param unread keys that could not be read; no warning depends on them
document::Problems fastHands(const scene::Scene& scene, const UnreadKeys& unread = {});

}  // namespace hapticd::diagnostics
