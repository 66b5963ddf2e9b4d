// SPDX-License-Identifier: MIT
#include "diagnostics/scene/slow_paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnostics/reading/far_limits.hpp"
#include "scene/path_rows.hpp"

namespace hapticd::diagnostics {
namespace {

using Path = std::vector<scene::PathPoint>;

/// [m] Returns the unit in which positions seem to be written: millimetres, if they are out of reach in metres.
double unitOf(const Path& path) {
  const bool far = std::any_of(path.begin(), path.end(),
                               [](const scene::PathPoint& point) { return point.pose.position.norm() > kFar; });
  return far ? 1e-3 : 1;
}

/// How fast a model moves along its path at most, and where it waits longest.
struct Pace {
  double speed = 0, turn = 0;  ///< [m/s], [rad/s]
  double longest = 0;          ///< [s] greatest time from one row to the next
  size_t row = 0;              ///< that next row
};

/// Returns the pace of a path whose times are whole numbers; nothing for any other path.
std::optional<Pace> paceOf(const Path& path) {
  Pace pace;
  const double unit = unitOf(path);
  for (size_t i = 0; i < path.size(); ++i) {
    if (path[i].t != std::round(path[i].t)) return std::nullopt;
    if (i == 0) continue;
    const double time = path[i].t - path[i - 1].t;
    const Eigen::Vector3d way = path[i].pose.position - path[i - 1].pose.position;
    pace.speed = std::max(pace.speed, unit * way.norm() / time);
    pace.turn = std::max(pace.turn, path[i].pose.orientation.angularDistance(path[i - 1].pose.orientation) / time);
    if (time > pace.longest) pace.longest = time, pace.row = i;
  }
  return pace;
}

}  // namespace

document::Problems slowPaths(const scene::Scene& scene) {
  constexpr double kCreep = 2e-4, kCreepTurn = 5e-3;  // [m/s], [rad/s]: a thousandth of a slow door
  constexpr double kLong = 10;                        // [s] for all of the path
  document::Problems warnings;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const Path& path = scene.models[i].path;
    const auto pace = paceOf(path);
    if (!pace || path.size() < 2 || path.back().t - path.front().t < kLong) continue;
    if (pace->speed + pace->turn == 0 || pace->speed > kCreep || pace->turn > kCreepTurn) continue;
    const scene::PathKey at = scene::keyOfPath(scene.models[i]);
    const auto line = scene::lineOfRow(at.csv, pace->row, path[pace->row].t);
    const std::string what = fmt::format(
        "{} takes {:g} s to come to this row, and creeps at {:.2g} m/s at most along its path{}; times must be in s: "
        "{:g} ms is {:g} s",
        scene.models[i].name, pace->longest, pace->speed, unitOf(path) < 1 ? " (of positions in mm)" : "",
        path[pace->row].t, path[pace->row].t / 1000);
    if (line)
      document::report(warnings, at.csv.string(), *line, 1, "t", what);
    else
      document::report(warnings, at.place, fmt::format("models[{}].path", i), what);
  }
  return warnings;
}

}  // namespace hapticd::diagnostics
