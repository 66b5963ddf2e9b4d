// SPDX-License-Identifier: MIT
/// What the parts of bench_trace share: surfaces, clock, solvers of one closest point a tick.
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

/// The surfaces of the tables: bicubic sheet, rational sphere and torus, degree 5, finely ridged sheet. About 0.2 m.
std::vector<spline::SurfaceData> surfaces();
/// `count` x `count` bicubic tiles of one wavy sheet, each a surface of its own.
std::vector<spline::SurfaceData> tiles(int count);

/// A probe that keeps contact: each true foot is known because the probe is built from it.
struct Path {
  std::vector<Eigen::Vector3d> probe, foot;
  std::vector<std::array<double, 2>> uv;
};
/// The walk of all tables.
inline constexpr int kTicks = 4000;
inline constexpr double kStep = 0.3e-3;   ///< [m] a tick: 0.3 m/s at 1 kHz
inline constexpr double kDepth = 2.5e-3;  ///< [m] to either side
/// `step` [m] a tick along the surface, up to `depth` [m] to either side of it.
Path contactPath(const spline::SurfaceData& data, double step, double depth, int ticks);

/// One way to find the closest point near the last one.
class Solver {
 public:
  virtual ~Solver() = default;
  virtual std::string name() const = 0;
  virtual void start(double u, double v) = 0;
  virtual Eigen::Vector3d step(const Eigen::Vector3d& probe) = 0;
  /// Most evaluations in any tick so far; 0 where the solver does not say.
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

/// Nanoseconds of `work()`, divided by `count`.
template <class Work>
double nanoseconds(int count, Work work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
  return time.count() / count;
}

/// The cost of a step of a walk of `kTicks`: the mean over short stretches of the best time of each in any round, so
/// that a busy machine interrupts few of them.
class Stretches {
 public:
  /// Walks once: step(i) for every i.
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

/// Keeps a result alive without storing it.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "r,m"(value) : "memory");
}

}  // namespace hapticd::bench
