// SPDX-License-Identifier: MIT
/// A surface model, a probe path, and the true distance at every tick.
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "kernels/spline/surface_data.hpp"

namespace hapticd::extremes {

struct Case {
  std::string name;
  std::vector<spline::SurfaceData> surfaces;
  double rate = 1000;  ///< [Hz]
  bool started = false;
  double start_u = 0, start_v = 0;     ///< parameters of the first foot, if `started`
  std::vector<Eigen::Vector3d> probe;  ///< [m] position of the probe in each tick
  std::vector<double> distance;        ///< [m] true distance in each tick; NaN if it is unknown
  /// [m] a foot is wrong if it is farther from the probe than the nearest point by more
  double allowed = 1e-4;
  bool bifurcation = false;  ///< the true nearest point jumps; the tracer may need 5 ms to follow
  /// the path runs through solids, and the truth is the nearest of all surfaces: no contact is held
  bool walk = false;
  bool alone = false;    ///< sizes that a scene cannot have: traced with the kernel alone
  int direct_steps = 0;  ///< steps per tick of direct parametric tracing; 0 for Newton's method
};

/// Returns the same case in another place: surfaces and path are rotated and shifted at random.
Case moved(const Case& c, std::mt19937& random);

/// The result of a tracer in one tick.
struct Answer {
  Eigen::Vector3d point{0, 0, 0}, normal{0, 0, 0};
  bool traced = false;
  int evaluations = 0;
};

/// Returns the answers of `hapticd trace`. @param hapticd path of the program @throws std::exception
std::vector<Answer> traceThroughDoor(const Case& c, const std::filesystem::path& hapticd);
/// Runs a session in virtual time with an arm that follows the path to the last bit, and returns the answers in its
/// recording. The recording must also pass a replay. @param modules folder of the test arm `walker` @throws
/// std::exception
std::vector<Answer> traceInSession(const Case& c, const std::filesystem::path& hapticd,
                                   const std::filesystem::path& modules);
/// Returns the answers of the kernel alone. A search runs every few ticks, as in a session.
std::vector<Answer> traceAlone(const Case& c);

/// Reads one file, see tests/cases/extremes/README.md. @throws std::exception
Case readCase(const std::filesystem::path& file);

/// Returns cases whose true distance has a closed form. They vary size (from subnormal numbers to 1e59 m), weights,
/// knots, degenerate patches, speeds and rates.
std::vector<Case> closedForms();

/// Returns walks over the models in config/models. The true distance comes from the global search.
std::vector<Case> modelWalks();

/// Returns random walks near random patches. The true distance comes from the global search. @param ticks number of
/// ticks of all walks together
std::vector<Case> randomWalks(int ticks);

}  // namespace hapticd::extremes
