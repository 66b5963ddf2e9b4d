// SPDX-License-Identifier: MIT
#include "diagnostics/scene/far_paths.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "diagnostics/reading/far_limits.hpp"
#include "scene/path_rows.hpp"

namespace hapticd::diagnostics {

document::Problems farPaths(const scene::Scene& scene) {
  document::Problems warnings;
  const auto isFar = [&scene](const scene::PathPoint& point) {
    return point.pose.position.norm() > kFar &&
           std::all_of(scene.devices.begin(), scene.devices.end(), [&point](const scene::Device& device) {
             return (point.pose.position - device.mount.position).norm() > kFar;
           });
  };
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const std::vector<scene::PathPoint>& path = scene.models[i].path;
    const auto far = std::find_if(path.begin(), path.end(), isFar);
    if (far == path.end()) continue;
    const Eigen::Vector3d& p = far->pose.position;
    Eigen::Index axis = 0;
    const double most = p.cwiseAbs().maxCoeff(&axis);
    const scene::PathKey at = scene::keyOfPath(scene.models[i]);
    const auto line = scene::lineOfRow(at.csv, static_cast<size_t>(far - path.begin()), far->t);
    const std::string what = fmt::format(
        "{} is {:.4g} m from the world's origin at t = {:g} s, where no arm reaches; positions must be in "
        "m: {:g} mm is {:g} m",
        scene.models[i].name, p.norm(), far->t, most, most / 1000);
    if (line)
      document::report(warnings, at.csv.string(), *line, 1, std::string(1, "xyz"[axis]), what);
    else
      document::report(warnings, at.place, fmt::format("models[{}].path", i), what);
  }
  return warnings;
}

}  // namespace hapticd::diagnostics
