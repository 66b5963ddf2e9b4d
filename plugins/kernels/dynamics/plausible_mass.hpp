// SPDX-License-Identifier: MIT
/// Which masses are probably wrong, for all who warn of a mass or choose one.
#pragma once

namespace hapticd::dynamics {

constexpr double kDensest = 25'000;  ///< [kg/m^3] denser than any metal
/// [kg] A hand moves so much with ease. No smaller mass is judged, however dense, because a light knob may stand for a
/// whole machine.
constexpr double kEasyMass = 3;

}  // namespace hapticd::dynamics
