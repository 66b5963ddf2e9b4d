// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "device_draft/device_draft.hpp"
#include "device_draft/draft_arm.hpp"
#include "device_draft/draft_wire.hpp"

namespace hapticd::device_draft {
namespace {

constexpr const char* kFile =
    R"(# {name}. Written by `hapticd device new`; each number is a guess until you have measured it.
hapticd-device: 1
module: usb_{bus}
name: {name}
{mount}limits: {{force: {force:g}, {torque}passivity: true}}   # N: begin low; raise it when the force has the right direction
{enable}parameters:
  usb: {{id: "{id}"}}
  # device: {{max_force: 5, max_stiffness: 1000, mass: 0.2}}      # properties for `check` and `tune`
{arm}  calibration:
    method: pose                  # or none, for absolute encoders; or device, if the arm finds its zero itself
    pose: [{pose}]               # rad: joint positions while the arm is held as described below
    instructions: "Hold every joint at its zero."
{wire})";

constexpr const char* kEnable =
    "# in limits: enable: {button: 0}   # forces only while the button is held; "
    "buttons count from 0 here, from 1 in wire\n";

}  // namespace

std::string deviceFileOf(const DeviceDraft& draft) {
  constexpr double kLever = 0.1;  // [m] the largest force at this lever makes the largest torque
  std::string pose = "0";
  for (int i = 1; i < draft.joints; ++i) pose += ", 0";
  const std::string torque = draft.joints > 3 ? fmt::format("torque: {:.2g}, ", kLever * draft.force) : "";
  return fmt::format(kFile, fmt::arg("name", draft.name), fmt::arg("bus", draft.bus), fmt::arg("mount", mountOf(draft)),
                     fmt::arg("force", draft.force), fmt::arg("torque", torque),
                     fmt::arg("enable", draft.buttons > 0 ? kEnable : ""), fmt::arg("id", draft.id),
                     fmt::arg("arm", armOf(draft)), fmt::arg("pose", pose), fmt::arg("wire", wireOf(draft)));
}

}  // namespace hapticd::device_draft
