// SPDX-License-Identifier: MIT
#include "diagnostics/scene/unfelt_models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "diagnostics/reading/far_limits.hpp"
#include "document/reader.hpp"
#include "hapticd/abi.h"
#include "host/file_stamp.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::diagnostics {

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

document::Problems softModels(const scene::Scene& scene, host::Catalog& catalog) {
  constexpr double kUnfelt = 5;  // [N/m] 10 mm of depth give 0.05 N, less than the friction of most arms
  document::Problems warnings;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const auto plugin = catalog.shape(scene.models[i].plugin);
    // A plugin may have a stiffness of another kind, such as one of turns in N m/rad.
    if (!plugin || (*plugin)->unitOf("stiffness") != "N/m") continue;
    const scene::Value* value = givenIn(scene.models[i].parameters, "stiffness");
    if (value != nullptr && value->kind == HSP_REAL && value->number < kUnfelt)
      document::report(warnings, value->place, "models[" + std::to_string(i) + "].parameters.stiffness",
                       document::numberText(value->number) + " N/m cannot be felt: 1 mm gives " +
                           document::numberText(value->number * 1e-3) +
                           " N; the value must be in N/m (1 N/mm is 1000 N/m)");
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

}  // namespace hapticd::diagnostics
