// SPDX-License-Identifier: MIT
#include "diagnostics/scene/arm_bounds.hpp"

#include <algorithm>

#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/scene/setting_plausibility.hpp"
#include "document/reader.hpp"
#include "hapticd/device.h"
#include "host/device_instance.hpp"
#include "tune/noisy_damping.hpp"
#include "tune/stability.hpp"

namespace hapticd::diagnostics {
namespace {

/// Returns what a device file says about its arm, without opening the arm. 0 means unknown.
hdv_info infoOf(const scene::Device& device) {
  hdv_info info{};
  info.capabilities = HDV_C_PACING;  // unknown: with this flag there is no warning that the arm cannot drive the loop
  info.max_stiffness = numberIn(device.parameters, "device.max_stiffness");
  info.mass_kg = numberIn(device.parameters, "device.mass");
  info.max_force = numberIn(device.parameters, "device.max_force");
  info.continuous_force = numberIn(device.parameters, "device.continuous_force");
  return info;
}

}  // namespace

document::Problems unstableContacts(const scene::Scene& scene, const std::vector<double>& stiffness) {
  document::Problems warnings = tune::fastPaths(scene);
  for (const scene::Device& device : scene.devices) {
    hdv_info info = infoOf(device);
    if (device.module == "simulated") {
      auto arm = host::DeviceInstance::create(device, nullptr);
      if (!arm || !(*arm)->open()) continue;
      info = (*arm)->info();
    }
    document::append(warnings, tune::unstableSettings(scene, device, info, stiffness));
    document::append(warnings, stiffTogether(scene, device, info, stiffness));
    document::append(warnings, lightAdmittance(scene, device, info));
    if (givenIn(device.parameters, "wire") != nullptr && info.max_stiffness <= 0 &&
        std::any_of(stiffness.begin(), stiffness.end(), [](double k) { return k > 0; }))
      document::report(
          warnings, device.place.file.empty() ? document::Place{device.file.string()} : device.place,
          "parameters.device.max_stiffness",
          "the value is not given, so it is unknown whether " + device.name +
              " is stable with these models; give the stiffness that was found stable, and begin with 100 N/m");
  }
  return warnings;
}

document::Problems knocksOfDamping(const scene::Scene& scene) {
  document::Problems warnings;
  for (const scene::Device& device : scene.devices) {
    if (device.module != "simulated") continue;  // the resolution of others is known once they are open
    auto arm = host::DeviceInstance::create(device, nullptr);
    if (arm && (*arm)->open()) document::append(warnings, tune::noisyDamping(scene, device, (*arm)->info()));
  }
  return warnings;
}

document::Problems idleBounds(const scene::Scene& scene) {
  document::Problems warnings;
  for (const scene::Device& device : scene.devices) {
    const double bound = device.limits.force > 0 ? device.limits.force : infoOf(device).max_force;
    if (bound > 0 && scene.clients.max_force > bound)
      document::report(warnings, document::Place{scene.file.string()}, "clients.max_force",
                       document::numberText(scene.clients.max_force) + " N, but " + device.name + " gives " +
                           document::numberText(bound) +
                           " N at most, so programs get no more; expected this force or less");
  }
  return warnings;
}

document::Problems unguardedPrograms(const scene::Scene& scene) {
  document::Problems warnings;
  if (scene.clients.mode == scene::ClientMode::kOff) return warnings;
  for (const scene::Device& device : scene.devices) {
    if (device.limits.passivity.value_or(true)) continue;
    document::report(warnings, placeOfKey(device.file, "limits.passivity").value_or(device.place), "limits.passivity",
                     "false, and programs may push (clients of the scene): only the force limit is left against a "
                     "program that goes along with the hand, which gives it energy for ever; leave passivity out");
  }
  return warnings;
}

}  // namespace hapticd::diagnostics
