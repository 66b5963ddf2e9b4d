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
  double start_u = 0, start_v = 0;     ///< parameters of the first foot, where they are given
  std::vector<Eigen::Vector3d> probe;  ///< a point a tick
  std::vector<double> distance;        ///< [m] true one; not-a-number where there is none
  double allowed = 1e-4;               ///< [m] a foot farther than this from the best one is wrong
  bool bifurcation = false;            ///< the nearest point truly jumps: 5 ms to recover
  bool walk = false;                   ///< through solids: the truth is the nearest of all surfaces, so nothing is held
  bool alone = false;                  ///< beyond what scenes may hold: traced by the kernel alone
  int direct_steps = 0;                ///< steps a tick of the paper's method; 0: Newton
};

/// The same in another place: turned and shifted at random.
Case moved(const Case& c, std::mt19937& random);

/// What a tracer answered in one tick.
struct Answer {
  Eigen::Vector3d point{0, 0, 0}, normal{0, 0, 0};
  bool traced = false;
  int evaluations = 0;
};

/// The answers of `hapticd trace`. @param hapticd the program @throws std::exception
std::vector<Answer> traceThroughDoor(const Case& c, const std::filesystem::path& hapticd);
/// The answers that a session recorded, in virtual time and over an arm that follows the path to the last bit; what it
/// recorded must replay. @param modules folder of the test arm `walker` @throws std::exception
std::vector<Answer> traceInSession(const Case& c, const std::filesystem::path& hapticd,
                                   const std::filesystem::path& modules);
/// The answers of the kernel, with a search beside it as in a session.
std::vector<Answer> traceAlone(const Case& c);

/// Reads one file, see tests/cases/extremes/README.md. @throws std::exception
Case readCase(const std::filesystem::path& file);

/// Cases with closed forms: sizes from subnormal to 1e59 m, weights, knots, degenerate patches, speeds and rates.
std::vector<Case> closedForms();

/// Walks over the models of config/models; the truth is the global search.
std::vector<Case> modelWalks();

/// Random walks near random patches; the truth is the global search. `ticks` in all.
std::vector<Case> randomWalks(int ticks);

}  // namespace hapticd::extremes
