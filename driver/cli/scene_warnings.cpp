// SPDX-License-Identifier: MIT
#include "cli/scene_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/command.hpp"
#include "diagnostics/reading/far_limits.hpp"
#include "diagnostics/scene/setting_plausibility.hpp"
#include "diagnostics/scene/value_plausibility.hpp"
#include "document/reader.hpp"
#include "host/device_instance.hpp"
#include "host/file_stamp.hpp"
#include "scene/load.hpp"
#include "tune/stability.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::cli {

using namespace diagnostics;

namespace {

/// Returns what a device file says about its arm, without opening the arm. 0 means unknown.
hdv_info infoOf(const scene::Device& device) {
  hdv_info info{};
  info.capabilities = HDV_C_PACING;  // unknown: with this flag there is no warning that the arm cannot drive the loop
  for (const scene::Value& value : device.parameters) {
    if (value.id == "device.max_stiffness") info.max_stiffness = value.number;
    if (value.id == "device.mass") info.mass_kg = value.number;
    if (value.id == "device.max_force") info.max_force = value.number;
    if (value.id == "device.continuous_force") info.continuous_force = value.number;
  }
  return info;
}

}  // namespace

scene::Scene withArm(scene::Scene scene) {
  if (const auto file = host::shippedFile(scene::kDefaultDevice); scene.devices.empty() && file)
    if (auto loaded = scene::loadDevice(*file, catalog()); loaded.device) {
      scene.devices.push_back(*loaded.device);
      scene.devices.back().chosen_by_default = true;
    }
  return scene;
}

document::Problems farModels(const scene::Scene& scene) {
  document::Problems warnings;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const Eigen::Vector3d& position = scene.models[i].pose.position;
    double away = position.norm();
    for (const scene::Device& device : scene.devices) away = std::min(away, (position - device.mount.position).norm());
    if (away > kFarModel)
      document::report(
          warnings, scene.models[i].place, "models[" + std::to_string(i) + "].pose.position",
          fmt::format("the model is {:.4g} m from the world's origin, where no arm reaches; the position must be in m",
                      position.norm()));
  }
  return warnings;
}

document::Problems softModels(const scene::Scene& scene) {
  constexpr double kUnfelt = 5;  // [N/m] 10 mm of depth give 0.05 N, less than the friction of most arms
  document::Problems warnings;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const auto plugin = catalog().shape(scene.models[i].plugin);
    // A plugin may have a stiffness of another kind, such as one of turns in N m/rad.
    if (!plugin || (*plugin)->unitOf("stiffness") != "N/m") continue;
    for (const scene::Value& value : scene.models[i].parameters)
      if (value.id == "stiffness" && value.kind == HSP_REAL && value.number < kUnfelt)
        document::report(warnings, value.place, "models[" + std::to_string(i) + "].parameters.stiffness",
                         document::numberText(value.number) + " N/m cannot be felt: 1 mm gives " +
                             document::numberText(value.number * 1e-3) +
                             " N; the value must be in N/m (1 N/mm is 1000 N/m)");
  }
  return warnings;
}

document::Problems unstableContacts(const scene::Scene& scene, const std::vector<double>& stiffness) {
  document::Problems warnings = tune::fastPaths(scene);
  for (const scene::Device& device : scene.devices) {
    hdv_info info = infoOf(device);
    if (device.module == "simulated") {
      auto arm = host::DeviceInstance::create(device, nullptr);
      if (!arm || !(*arm)->open()) continue;
      info = (*arm)->info();
    }
    for (const document::Problems& found :
         {tune::unstableSettings(scene, device, info, stiffness), stiffTogether(scene, device, info, stiffness),
          lightAdmittance(scene, device, info)})
      warnings.insert(warnings.end(), found.begin(), found.end());
    const bool described = std::any_of(device.parameters.begin(), device.parameters.end(),
                                       [](const scene::Value& value) { return value.id == "wire"; });
    if (described && info.max_stiffness <= 0 &&
        std::any_of(stiffness.begin(), stiffness.end(), [](double k) { return k > 0; }))
      document::report(
          warnings, device.place.file.empty() ? document::Place{device.file.string()} : device.place,
          "parameters.device.max_stiffness",
          "the value is not given, so it is unknown whether " + device.name +
              " is stable with these models; give the stiffness that was found stable, and begin with 100 N/m");
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

document::Problems quarantinedModels(const scene::Scene& scene) {
  document::Problems warnings;
  const auto dir = watch::stateFolder();
  if (dir.empty()) return warnings;
  for (const watch::QuarantinedPlugin& entry : watch::quarantined(dir))
    for (size_t i = 0; i < scene.models.size(); ++i)
      if (entry.holds(scene.models[i].plugin, host::identityOnDisk(scene.models[i].library)))
        document::report(warnings, scene.models[i].place, "models[" + std::to_string(i) + "].plugin",
                         entry.plugin + " is in quarantine, because it ended an earlier run by " + entry.reason +
                             "; runs leave " + scene.models[i].name +
                             " out; once the plugin is repaired: hapticd plugin clear " + entry.plugin);
  return warnings;
}

void addImplausible(const scene::Scene& scene, const ModelBoxes& boxes, const UnreadKeys& unread,
                    document::Problems& warnings) {
  document::Problems more = implausibleValues(scene, boxes, catalog(), unread);
  for (const document::Problem& one : implausibleSettings(scene, boxes))
    // Warnings about arms can be trusted, because checkDraft() leaves out arms with problems.
    if ((one.key.starts_with("devices[") || !unread.has(one.key)) &&
        !(one.key == "clients.answer_time" && unread.has("servo.rate")) &&
        !(one.what.find("no program may push") != std::string::npos && unread.has("clients.mode")))
      more.push_back(one);
  const size_t before = warnings.size();
  for (const document::Problem& one : more)
    if (std::none_of(warnings.begin(), warnings.begin() + static_cast<std::ptrdiff_t>(before),
                     [&one](const document::Problem& told) {
                       return told.key == one.key && told.place.line == one.place.line &&
                              told.place.column == one.place.column && !told.key.ends_with(".pose");
                     }))
      warnings.push_back(one);
}

std::vector<std::string> warningsOfModels(const servo::Runner& runner, const scene::Scene& models,
                                          const std::vector<double>& stiffness) {
  scene::Scene scene = models;
  scene.servo = runner.scene().servo;
  scene.devices = runner.scene().devices;
  document::Problems all = farModels(scene);
  const auto add = [&all](document::Problems more) {
    for (document::Problem& one : more) all.push_back(std::move(one));
  };
  add(softModels(models));
  add(tune::fastPaths(models));
  add(implausibleValues(scene, {}, catalog()));
  for (size_t i = 0; i < runner.arms().size(); ++i)
    add(tune::unstableSettings(scene, runner.scene().devices[i], runner.arms()[i]->info(), stiffness));
  std::vector<std::string> texts;
  for (const document::Problem& one : all) texts.push_back(one.text());
  return texts;
}

}  // namespace hapticd::cli
