// SPDX-License-Identifier: MIT
/// Distances beyond which a place is probably not in metres.
#pragma once

namespace hapticd::diagnostics {

/// [m] Nobody reaches so far: an arm does not stand there, and a model that passes by an arm comes from nearer places.
inline constexpr double kFar = 5;
/// [m] A model that rests is reported from here on; up to here it may belong to a larger room that is only shown.
inline constexpr double kFarModel = 10;

}  // namespace hapticd::diagnostics
