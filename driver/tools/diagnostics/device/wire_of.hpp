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
  try {
    for (const scene::Value& value : device.parameters)
      if (value.id == "wire") return codec::readWire(value.text, joints);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  return std::nullopt;
}

/// [main] Returns the wire format of a device. If it has mistakes, returns its correct parts, which only checks of
/// single fields may use.
inline std::optional<codec::Wire> wireDraftOf(const scene::Device& device, size_t joints) {
  if (auto right = wireOf(device, joints)) return right;
  try {
    for (const scene::Value& value : device.parameters)
      if (value.id == "wire") return codec::draftOfWire(value.text, joints);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace hapticd::diagnostics
