// SPDX-License-Identifier: MIT
/// Decides which settings to try, which of them are worth having, and which one to choose.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "tune/knob.hpp"
#include "tune/measurement.hpp"
#include "tune/touches.hpp"

namespace hapticd::tune {

/// The goal of the user. The chosen setting has at most half of each tolerated error, so that the errors over other
/// motions stay within the tolerances too.
struct Goal {
  std::optional<double> budget_ns;  ///< if given, choose the most accurate setting whose p99 is at most this; if not,
                                    ///< choose the cheapest one within the tolerances
  double tolerance_m = 1e-6;        ///< [m] tolerance of foot and depth
  double force_tolerance_n = 0.1;
};

struct Candidate {
  Choice choice;
  Cost cost;
  Difference error;  ///< difference from the converged reference
  bool on_front = false;
  /// number in tables and pictures, from 1; 0 for a setting that has no number and is drawn as a dot only
  size_t point = 0;
};

struct Progress {
  size_t done = 0, expected = 0;
  double seconds_left = 0;
};

struct Tuning {
  std::vector<Candidate> candidates;  ///< candidates[0] is the scene as written
  size_t chosen = 0;
  bool reached = false;          ///< true if the chosen setting meets the goal
  bool complete = false;         ///< true if neither the time limit nor the user stopped the search
  bool out_of_time = false;      ///< true if the time limit stopped the search
  size_t planned = 0;            ///< number of settings to try
  std::vector<Touches> touches;  ///< of the converged reference
};

struct SearchOptions {
  Goal goal;
  double seconds = 50;  ///< [s] time limit of the search
  /// Called after each setting; false stops the search with the results so far.
  std::function<bool(const Progress&)> go_on;
  host::Services::Log log;
};

/// [main] Measures the scene as written and each value of each knob alone. If there are few combinations, it measures
/// them all. Otherwise it starts from the best setting so far, changes one knob at a time, and goes on as long as that
/// helps.
Result<Tuning> search(const scene::Scene& scene, const Motion& motion, const std::vector<Knob>& knobs,
                      const SearchOptions& options);
/// [m], [N] errors below these are rounding errors and count as equal
constexpr double kErrorNoise = 1e-10, kForceNoise = 1e-7;

/// Returns true if a costs less than b by more than the noise, so that the intervals of their times do not overlap.
bool clearlyCheaper(const Candidate& a, const Candidate& b);

/// Marks the candidates that no other candidate beats. A beats B if none of A's errors is larger and A is clearly
/// cheaper, or if A's median is not larger and one of A's errors is smaller.
void markFront(std::vector<Candidate>& candidates);

/// Returns true if two candidates are equal except for the noise of timing and rounding.
bool alike(const Candidate& a, const Candidate& b);

/// Returns the index of the candidate that is alike and changes the fewest parameters of the scene, so that a parameter
/// without effect, such as the tolerance of another method, is not named. For one of the front it is one of the front.
size_t simplest(const std::vector<Candidate>& candidates, size_t like);

/// Returns the index of the candidate to choose, and whether it meets the goal.
std::pair<size_t, bool> choose(const std::vector<Candidate>& candidates, const Goal& goal);

}  // namespace hapticd::tune
