// SPDX-License-Identifier: MIT
/// Reads the wire format of a device file, for checks that need no arm.
#pragma once
#include <optional>
#include <stdexcept>

#include "codec/wire.hpp"
#include "description/scene.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the wire format of a device; nothing if the arm has none or a wrong one. Other functions report a
/// wrong format as a problem.
inline std::optional<codec::Wire> wireOf(const scene::Device& device, size_t joints) {
  const scene::Value* wire = givenIn(device.parameters, "wire");
  if (wire == nullptr) return std::nullopt;
  try {
    return codec::readWire(wire->text, joints);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// [main] Returns the wire format of a device. If it has mistakes, returns its correct parts, which only checks of
/// single fields may use.
inline std::optional<codec::Wire> wireDraftOf(const scene::Device& device, size_t joints) {
  if (auto right = wireOf(device, joints)) return right;
  const scene::Value* wire = givenIn(device.parameters, "wire");
  if (wire == nullptr) return std::nullopt;
  try {
    return codec::draftOfWire(wire->text, joints);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace hapticd::diagnostics
