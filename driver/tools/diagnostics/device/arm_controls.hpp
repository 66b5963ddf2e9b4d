// SPDX-License-Identifier: MIT
/// Finds which of the safety measures (controls) of driver/docs/hazards.md one arm has, from its device file, from its
/// module, and from the arm itself if it is plugged in.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

enum class ControlState { kOn, kOff, kUnknown };
const char* nameOf(ControlState state);  ///< "on", "off", "unknown"

struct Control {
  std::string hazards;  ///< numbers of the hazards in hazards.md, such as "H1 H2"
  std::string name;
  ControlState state = ControlState::kUnknown;
  std::string text;  ///< what the control does and its bounds; if it is off, how to enable it
};

/// [main] @param device created from the description, and opened if the arm is present
std::vector<Control> controlsOf(const scene::Device& description, const host::DeviceInstance& device, bool opened);

/// The controls and facts that were found for one device file.
struct ArmControls {
  std::string arm;
  bool opened = false;  ///< false if the arm is absent; facts that only the arm can give are then unknown
  std::vector<Control> controls;
  bool silenced_after_us = false;   ///< true if something switches the arm's motors off when the daemon has ended
  std::vector<std::string> doubts;  ///< warnings of the module about its parameters; a run does not refuse them
  bool simulated = false;           ///< true for a simulated arm, which has no motors
  /// true if the arm's hardware switches its motors off when no commands come, as far as is known
  bool watchdog = false;
  std::string why;            ///< why the arm could not be opened; "" if it could
  std::string slow;           ///< why the arm pushes less than its limits allow; "" if it does not
  std::string usb_id;         ///< "1209:0006"; "" for an arm on another bus
  bool repeats_pass = false;  ///< true if it would not be noticed that the arm sends the same report again and again
};

/// [main] Loads the file, opens the arm if it is present, and moves nothing. If the file has problems, adds them to
/// `problems` and returns nothing.
std::optional<ArmControls> controlsOfFile(const std::string& file, host::Catalog& catalog,
                                          document::Problems& problems);

}  // namespace hapticd::diagnostics
