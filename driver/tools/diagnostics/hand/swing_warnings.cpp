// SPDX-License-Identifier: MIT
#include "diagnostics/hand/swing_warnings.hpp"

#include <fmt/format.h>

#include "diagnostics/reading/key_place.hpp"

namespace hapticd::diagnostics {

bool reportSwing(const scene::Scene& scene, uint32_t index, const WalkedArm& seen, document::Problems& warnings) {
  if (seen.swing.fastest() == 0) return false;
  const scene::Device& device = scene.devices[index];
  const std::string less = device.admittance ? "more admittance.damping" : "less stiffness";
  const std::string own =
      seen.rate > scene.servo.rate ? fmt::format(", such as the {:g} Hz of the arm's samples", seen.rate) : "";
  document::report(
      warnings, placeOfKey(scene.file, "servo.rate").value_or(document::Place{scene.file.string(), 1, 1}), "servo.rate",
      fmt::format(
          "the tip of {} swings by more than {:g} mm, {:.0f} times a second, as no hand moves it: the arm is not "
          "stable at {:g} Hz; expected a higher rate{}, or {}",
          device.name, servo::Swing::kSwing * 1e3, seen.swing.fastest(), scene.servo.rate, own, less));
  return true;
}

}  // namespace hapticd::diagnostics
