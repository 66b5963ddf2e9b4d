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
  std::string text;  ///< how far the control goes; if it is off, how to enable it
};

/// [main] @param device created from the description, and opened if the arm is present
std::vector<Control> controlsOf(const scene::Device& description, const host::DeviceInstance& device, bool opened);

/// The controls and facts that were found for one device file.
struct ArmControls {
  std::string arm;
  bool opened = false;  ///< false if the arm is absent: facts that only it can give are unknown
  std::vector<Control> controls;
  bool silenced_after_us = false;   ///< something switches its motors off when the daemon has gone
  std::vector<std::string> doubts;  ///< about its module, which no run refuses
  bool simulated = false;           ///< it has no motors
  bool watchdog = false;            ///< its own hardware does so when commands stop, as far as is known
  std::string why;                  ///< why it could not be opened; "" if it could
  std::string slow;                 ///< why it pushes less than its limits allow; "" if it does not
  std::string usb_id;               ///< "1209:0006"; "" for an arm on another bus
  bool repeats_pass = false;        ///< the same report, sent repeatedly, would not be noticed
};

/// [main] Loads the file, opens the arm if it is present, and moves nothing. Returns nothing if the file has problems,
/// which `problems` gets.
std::optional<ArmControls> controlsOfFile(const std::string& file, host::Catalog& catalog,
                                          document::Problems& problems);

}  // namespace hapticd::diagnostics
