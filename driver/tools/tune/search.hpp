// SPDX-License-Identifier: MIT
/// Which settings to try, which of them are worth having, and which to take.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tune/knob.hpp"
#include "tune/measurement.hpp"

namespace hapticd::tune {

/// What the user asks for. Errors are kept at half the tolerance, so that other motions stay within it too.
struct Goal {
  std::optional<double> budget_ns;  ///< most accurate with a p99 below this; none: cheapest within the tolerances
  double tolerance_m = 1e-6;        ///< of foot and depth
  double force_tolerance_n = 0.1;
};

struct Candidate {
  Choice choice;
  Cost cost;
  Difference error;  ///< from the converged reference
  bool on_front = false;
  size_t point = 0;  ///< number in tables and pictures, from 1; 0: only a dot
};

struct Progress {
  size_t done = 0, expected = 0;
  double seconds_left = 0;
};

struct Tuning {
  std::vector<Candidate> candidates;  ///< [0] is the scene as it is
  size_t chosen = 0;
  bool reached = false;      ///< the chosen setting meets the goal
  bool complete = false;     ///< neither the time limit nor the user cut it short
  bool out_of_time = false;  ///< the time limit cut it short
  size_t planned = 0;        ///< how many settings there were to try
};

struct SearchOptions {
  Goal goal;
  double seconds = 50;                         ///< stop trying after this
  std::function<bool(const Progress&)> go_on;  ///< called after each; false: stop with the results so far
  host::Services::Log log;
};

/// [main] Measures the scene as it is and each value of each knob alone. If there are few combinations it measures them
/// all, and otherwise those on the way down from the scene's settings, one knob at a time.
Result<Tuning> search(const scene::Scene& scene, const Motion& motion, const std::vector<Knob>& knobs,
                      const SearchOptions& options);

constexpr double kErrorNoise = 1e-10, kForceNoise = 1e-7;  ///< [m], [N] rounding errors: smaller errors count as equal

/// True if a costs less than b beyond the noise: the intervals of their times do not overlap.
bool clearlyCheaper(const Candidate& a, const Candidate& b);

/// Marks the candidates that no other beats. Another beats one if its errors are nowhere larger and it is clearly
/// cheaper; or its median is no larger and one of its errors is smaller.
void markFront(std::vector<Candidate>& candidates);

/// True if they are equal except for the noise of timing and rounding.
bool alike(const Candidate& a, const Candidate& b);

/// The index of the candidate to choose, and whether it meets the goal.
std::pair<size_t, bool> choose(const std::vector<Candidate>& candidates, const Goal& goal);

}  // namespace hapticd::tune
