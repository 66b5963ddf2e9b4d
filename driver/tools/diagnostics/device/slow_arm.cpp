// SPDX-License-Identifier: MIT
#include "diagnostics/device/slow_arm.hpp"

#include <algorithm>

#include "diagnostics/device/device_wire.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "document/reader.hpp"
#include "host/device_instance.hpp"
#include "servo/safety/held_command.hpp"

namespace hapticd::diagnostics {
namespace {

/// [N] Returns the largest force as the limiter uses it: the smaller of limits.force and the arm's own force, as far as
/// they are known.
double forceOf(const scene::Device& device, double own) {
  const double asked = device.limits.force;
  return asked > 0 && own > 0 ? std::min(asked, own) : std::max(asked, own);
}

/// Adds the warning. If the arm's own rate is too low, it is placed at the rate in the device file, otherwise at the
/// rate of the servo.
void reportSlow(const scene::Scene& scene, const scene::Device& device, const std::string& slow,
                document::Problems& warnings) {
  const bool own = slow.starts_with("its own rate");
  for (const char* key : {"parameters.wire.rate", "parameters.rate"})
    if (const auto place = own ? placeOfKey(device.file, key) : std::nullopt)
      return document::report(warnings, *place, key, document::numberText(namedRate(device)) + " Hz: " + slow);
  document::report(warnings, scene.file.string(), 0, 0, "servo.rate", device.name + ": " + slow);
}

}  // namespace

double namedRate(const scene::Device& device) {
  if (const double given = numberIn(device.parameters, "rate"); given > 0) return given;
  const auto arm = host::DeviceInstance::create(device, [](int, const std::string&, const std::string&) {});
  if (!arm) return 0;
  const auto wire = wireOf(device, (*arm)->kinematics().joint_count);
  return wire ? wire->rate : 0;
}

std::string slownessOf(const scene::Device& device, double servo_rate) {
  if (device.module == "simulated") return "";
  const double own =
      std::max(numberIn(device.parameters, "device.max_force"), numberIn(device.parameters, "max_force"));
  return servo::describeSlow(servo_rate, namedRate(device), own, forceOf(device, own));
}

document::Problems slowArms(const scene::Scene& scene) {
  document::Problems warnings;
  for (const scene::Device& device : scene.devices)
    if (const std::string slow = slownessOf(device, scene.servo.rate); !slow.empty())
      reportSlow(scene, device, slow, warnings);
  return warnings;
}

}  // namespace hapticd::diagnostics
