// SPDX-License-Identifier: MIT
#include "subjects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "kernels/spline/surface.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::table1 {

using Eigen::Vector3d;

const char* const kWall = "stiffness: 6000, damping: 100, exponent: 0.5, depth_scale: 0.001";
const char* const kMotionOfSolids =
    "move freely by the push, against 20 N s/m, 10 N m s/rad and a spring of 60 N/m that keeps them in reach";

namespace {

double swing(double t, double rate, double phase = 0) {
  return std::sin(2 * M_PI * rate * t + phase);
}

/// Returns a route round the front of a cube with the half side a: over the front face, round an upright edge and over
/// the side face. Near an edge the finger is lifted and goes round it at a distance. If it were pressed round the edge,
/// its contact would be held on the face from which it came.
Aim cubeRoute(double a, double t) {
  constexpr double kLift = 0.02, kClear = 0.03, kTurn = kLift * M_PI / 2;  // [m]
  const double way = (2 * a + kTurn) * swing(t, 0.08), side = way < 0 ? -1 : 1;
  const double y = 0.9 * a * swing(t, 0.031, 0.4), past = std::abs(way) - a;
  const double from_edge = past <= 0 ? -past : std::max(0.0, past - kTurn);
  const double angle = M_PI / 2 * std::clamp(past / kTurn, 0.0, 1.0), near = std::max(0.0, 1 - from_edge / kClear);
  Aim aim;
  aim.normal = Vector3d(side * std::sin(angle), 0, std::cos(angle));
  aim.point = past <= 0 ? Vector3d(way, y, a) : Vector3d(side * a, y, a - from_edge);
  aim.point += kLift * near * near * (3 - 2 * near) * aim.normal;
  aim.room = std::min(std::max(0.0, from_edge - kClear), a - std::abs(y));
  return aim;
}

Aim cylinderRoute(double radius, double half_height, double t) {
  const double angle = 1.7 * swing(t, 0.1), y = 0.7 * half_height * swing(t, 0.037);
  Aim aim;
  aim.normal = Vector3d(std::sin(angle), 0, std::cos(angle));
  aim.point = radius * aim.normal + y * Vector3d::UnitY();
  aim.room = std::min(radius, half_height - std::abs(y));
  return aim;
}

Aim ballRoute(double radius, double t) {
  const double angle = 1.3 * swing(t, 0.12), rise = 0.5 * swing(t, 0.043);
  Aim aim;
  aim.normal = Vector3d(std::sin(angle) * std::cos(rise), std::sin(rise), std::cos(angle) * std::cos(rise));
  aim.point = radius * aim.normal;
  aim.room = radius;
  return aim;
}

Aim capRoute(double a, double t) {
  Aim aim;
  aim.normal = Vector3d::UnitY();
  aim.point = Vector3d(0.6 * a * swing(t, 0.11), a, 0.6 * a * swing(t, 0.047, 1));
  aim.room = a - std::max(std::abs(aim.point.x()), std::abs(aim.point.z()));
  return aim;
}

/// Returns a route on the goblet, from its stem over the bowl to below the rim. Points and normals come from the spline
/// of the goblet.
std::function<Aim(double)> gobletRoute(const std::string& file, double scale) {
  ModelFile model = readModelFile(file);
  for (Vector3d& point : model.surfaces.at(1).points) point *= scale;
  const auto outside = std::make_shared<const spline::Surface>(model.surfaces.at(1));
  return [outside](double t) {
    const double turn = 0.27 * swing(t, 0.1), v = 0.62 + 0.27 * swing(t, 0.037);
    spline::SurfacePoint at;
    outside->evaluate1(turn < 0 ? turn + 1 : turn, v, at);
    Aim aim;
    aim.point = at.S;
    aim.normal = at.Su.cross(at.Sv).normalized();
    aim.room = std::hypot(at.S.x(), at.S.z());
    return aim;
  };
}

Plugin pushButton() {
  std::string detent;
  for (const auto& [travel, force] : kDetent)
    detent += fmt::format("{}[{}, {}]", detent.empty() ? "" : ", ", travel, force);
  return {"push_button", "",
          fmt::format("stiffness: {}, axis: [0, -1, 0], detent: [{}], end_stiffness: {}", kSurface, detent, kEndSlope)};
}

}  // namespace

std::vector<Subject> subjects() {
  const Plugin rigid{"nurbs_rigid", "dynamic",
                     std::string(kWall) + ", mass: 40, gravity: false, tether: 60, drag: 20, angular_drag: 10"};
  const Plugin swings{"pendulum", "",
                      "stiffness: 6000, contact_damping: 100, exponent: 0.5, depth_scale: 0.001, pivot: [0, 0.5, 0], "
                      "axis: [0, 0, 1], mass: 40, inertia: 10.16, length: 0.5, damping: 5, angle: 0.15"};
  const std::string models = HAPTICD_SOURCE_DIR "/config/models/";
  return {{"cube",
           "box.yaml",
           2.5,
           rigid,
           [](double t) { return cubeRoute(0.125, t); },
           {{1.12, 0.71, 5.58}, {2.05, 1.59, 8.18}}},
          {"cylinder",
           "cylinder.yaml",
           2.5,
           rigid,
           [](double t) { return cylinderRoute(0.1, 0.125, t); },
           {{1.93, 1.16, 6.11}, {1.14, 1.42, 11.23}}},
          {"goblet",
           "goblet.yaml",
           3,
           rigid,
           gobletRoute(models + "goblet.yaml", 3),
           {{2.40, 1.79, 9.30}, {0.68, 0.51, 3.41}}},
          {"pendulum",
           "sphere.yaml",
           2,
           swings,
           [](double t) { return ballRoute(0.1, t); },
           {{1.93, 1.39, 9.84}, {2.79, 1.79, 9.10}}},
          {"button",
           "box.yaml",
           2.5,
           pushButton(),
           [](double t) { return capRoute(0.125, t); },
           {{1.30, 0.85, 4.75}, {1.00, 0.53, 3.18}},
           -0.2}};
}

}  // namespace hapticd::table1
