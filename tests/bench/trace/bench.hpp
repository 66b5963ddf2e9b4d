// SPDX-License-Identifier: MIT
/// What the parts of bench_trace share: surfaces, the measurement of times, and solvers that find one closest point per
/// tick.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "kernels/spline/surface.hpp"

namespace hapticd::bench {

/// Returns the surfaces of the tables, of about 0.2 m: a bicubic sheet, a rational sphere and torus, a sheet of degree
/// 5, and a finely ridged sheet.
std::vector<spline::SurfaceData> surfaces();
/// Returns `count` x `count` bicubic tiles of one wavy sheet. Each tile is a surface of its own.
std::vector<spline::SurfaceData> tiles(int count);

/// The path of a probe near a surface. Each probe is constructed from its foot, so the true foot is known exactly.
struct Path {
  std::vector<Eigen::Vector3d> probe, foot;
  std::vector<std::array<double, 2>> uv;
};
/// Number of ticks of the walk in all tables.
inline constexpr int kTicks = 4000;
inline constexpr double kStep = 0.3e-3;   ///< [m] motion per tick: 0.3 m/s at 1 kHz
inline constexpr double kDepth = 2.5e-3;  ///< [m] greatest distance from the surface, on both sides
/// Returns a path that moves along the surface by `step` [m] per tick, up to `depth` [m] away from it on both sides.
Path contactPath(const spline::SurfaceData& data, double step, double depth, int ticks);

/// A method that finds the closest point near the last one.
class Solver {
 public:
  virtual ~Solver() = default;
  virtual std::string name() const = 0;
  virtual void start(double u, double v) = 0;
  virtual Eigen::Vector3d step(const Eigen::Vector3d& probe) = 0;
  /// Returns the most evaluations in any tick so far; 0 if the solver does not count them.
  virtual int worstEvaluations() const { return 0; }
};

std::vector<std::unique_ptr<Solver>> ourSolvers(const spline::SurfaceData& data);
std::vector<std::unique_ptr<Solver>> occtSolvers(const spline::SurfaceData& data);
std::vector<std::unique_ptr<Solver>> sislSolvers(const spline::SurfaceData& data);

void printEvaluations();
void printFloat();
void printTicks();
void printCold();
void printMany();
void printScale();

/// Returns the time [ns] that `work()` takes, divided by `count`.
template <class Work>
double nanoseconds(int count, Work work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
  return time.count() / count;
}

/// Measures the time of a step of a walk with kTicks steps. The walk is divided into short stretches. For each stretch
/// the shortest time over all rounds counts, so that interruptions by other load hardly matter. The result is the mean
/// of these times.
class Stretches {
 public:
  /// Makes one round: calls step(i) for every i.
  template <class Step>
  void walk(Step step) {
    for (std::size_t k = 0; k < best_.size(); ++k) {
      const double ns = nanoseconds(kStretch, [&] {
        for (std::size_t i = k * kStretch; i < (k + 1) * kStretch; ++i) step(i);
      });
      best_[k] = std::min(best_[k], ns);
    }
  }
  double mean() const { return std::accumulate(best_.begin(), best_.end(), 0.0) / static_cast<double>(best_.size()); }

 private:
  static constexpr int kStretch = 100;
  static_assert(kTicks % kStretch == 0);
  std::vector<double> best_ = std::vector<double>(kTicks / kStretch, HUGE_VAL);
};

/// Makes the compiler compute a value although nothing uses it.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "r,m"(value) : "memory");
}

}  // namespace hapticd::bench
