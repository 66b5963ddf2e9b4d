// SPDX-License-Identifier: MIT
/// Which of the controls of driver/docs/hazards.md one arm has: by its device file, by its module, and, where it is
/// plugged in, by the arm itself.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

enum class Verdict { kOn, kOff, kUnknown };
const char* nameOf(Verdict verdict);  ///< "on", "off", "unknown"

struct Control {
  std::string hazards;  ///< of hazards.md, "H1 H2"
  std::string name;
  Verdict verdict = Verdict::kUnknown;
  std::string text;  ///< how far it goes; where it is off, what it takes to have it
};

/// [main] @param device created from the description; opened, if the arm is there
std::vector<Control> controlsOf(const scene::Device& description, const host::DeviceInstance& device, bool opened);

}  // namespace hapticd::diagnostics
