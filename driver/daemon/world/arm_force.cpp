// SPDX-License-Identifier: MIT
#include "world/arm_force.hpp"

#include <algorithm>
#include <string_view>

#include "host/class_params.hpp"
#include "host/device_instance.hpp"

namespace hapticd::servo {

namespace {

constexpr std::string_view kNames[] = {"device.max_force",
                                       "max_force"};  ///< names of the parameter for the largest force

/// Returns the smaller of two forces [N], as the limiter does; 0 means unknown.
double letThrough(double asked, double device) {
  return asked > 0 && device > 0 ? std::min(asked, device) : std::max(asked, device);
}

/// Returns the largest force [N] by the module's parameter, as given or by default; 0 if it has no such parameter.
double describedForce(const scene::Device& device) {
  // Messages are dropped here: they come again when the device is opened.
  const auto instance = host::DeviceInstance::create(device, [](int, const std::string&, const std::string&) {});
  if (!instance) return 0;
  const hdv_class& module = (*instance)->description();
  for (uint32_t i = 0; i < module.param_count; ++i) {
    const hsp_param& param = host::paramAt(module, i);
    if (std::find(std::begin(kNames), std::end(kNames), param.id) == std::end(kNames)) continue;
    for (const scene::Value& value : device.parameters)
      if (value.index == i) return value.number;
    return param.def;
  }
  return 0;
}

/// Returns the largest of the forces, or 0 (unknown) if one of them is unknown.
double largest(const std::vector<double>& forces) {
  if (forces.empty() || *std::min_element(forces.begin(), forces.end()) <= 0) return 0;
  return *std::max_element(forces.begin(), forces.end());
}

}  // namespace

double maxForceOf(const scene::Scene& scene) {
  std::vector<double> forces;
  for (const scene::Device& device : scene.devices)
    forces.push_back(letThrough(device.limits.force, describedForce(device)));
  return largest(forces);
}

double maxForceOf(const scene::Scene& scene, const std::vector<hdv_info>& devices) {
  std::vector<double> forces;
  for (size_t i = 0; i < std::min(scene.devices.size(), devices.size()); ++i)
    forces.push_back(letThrough(scene.devices[i].limits.force, devices[i].max_force));
  return largest(forces);
}

}  // namespace hapticd::servo
