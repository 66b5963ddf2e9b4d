// SPDX-License-Identifier: MIT
/// The ten skeletons on which searches are judged, and the truth by brute force.
#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial::test {

struct Sheet {
  const char* name;
  std::function<Eigen::Vector3d(double, double)> at;  ///< centre at grid coordinates 0..1
  bool curve = false;
};

inline std::vector<Sheet> sheets() {
  using Eigen::Vector3d;
  const auto skew = [](double degrees) {
    const double a = degrees * M_PI / 180;
    return [a](double s, double t) { return Vector3d(.1 * s + .1 * t * std::cos(a), .1 * t * std::sin(a), 0); };
  };
  return {
      {"flat", [](double s, double t) { return Vector3d(.1 * s, .08 * t, 0); }},
      {"skew 20", skew(20)},
      {"skew 45", skew(45)},
      {"skew 70", skew(70)},
      {"dome", [](double s, double t) { return Vector3d(.1 * s, .1 * t, .04 * (s * (1 - s) + t * (1 - t))); }},
      {"saddle", [](double s, double t) { return Vector3d(.1 * s, .1 * t, .1 * (s - .5) * (t - .5)); }},
      {"helix",
       [](double s, double t) { return Vector3d(.03 * t * std::cos(3 * s), .03 * t * std::sin(3 * s), .08 * s); }},
      {"bumpy", [](double s, double t) { return Vector3d(.1 * s, .1 * t, .006 * std::sin(7 * s) * std::cos(6 * t)); }},
      {"tube", [](double s, double t) { return Vector3d(.04 * std::cos(4 * t), .04 * std::sin(4 * t), .1 * s); }},
      {"cusp-like",
       [](double s, double t) { return Vector3d(.1 * s, .1 * t, -.03 * std::pow(std::fabs(t - .5), 2.0 / 3)); }},
      {"nearly degenerate", [](double s, double t) { return Vector3d(.1 * s, .1 * t * (.02 + s), 0); }},
      {"1 x n", [](double, double t) { return Vector3d(.1 * t, .02 * std::sin(4 * t), .01 * std::cos(5 * t)); }, true},
  };
}

inline Skeleton build(const Sheet& sheet, bool varying, spline::Form form = spline::Form::kTable) {
  constexpr int kCount = 7;
  SkeletonGrid grid;
  grid.count = {sheet.curve ? 1 : kCount, kCount};
  for (int i = 0; i < grid.count[0]; ++i) {
    for (int j = 0; j < kCount; ++j) {
      const double s = i / (kCount - 1.0), t = j / (kCount - 1.0);
      grid.points.push_back(sheet.at(s, t));
      grid.radius.push_back(.01 + (varying ? .004 * std::sin(3 * s + 2 * t) : 0));
    }
  }
  return Skeleton(grid, 3, form);
}

/// Depth by brute force: dense samples made once, then ever finer grids about the best of them.
class BruteForce {
 public:
  explicit BruteForce(const Skeleton& skeleton) : skeleton_(skeleton) {
    spline::SurfacePoint s;
    for (int i = 0; i <= (skeleton.curve() ? 0 : kSamples); ++i) {
      for (int j = 0; j <= kSamples; ++j) {
        const double u = double(i) / kSamples, v = double(j) / kSamples;
        skeleton.surface().evaluate1(u, v, s);
        samples_.push_back({s.S, skeleton.radius().evaluate(u, v).f, u, v});
      }
    }
  }

  double depth(const Eigen::Vector3d& p) const {
    const Sample* best = nullptr;
    double most = -HUGE_VAL;
    for (const Sample& sample : samples_) {
      const double d = sample.radius - (p - sample.center).norm();
      if (d > most) most = d, best = &sample;
    }
    double bu = best->u, bv = best->v, width = 1.5 / kSamples;
    for (int level = 0; level < 14; ++level, width *= .4) {
      const double cu = bu, cv = bv;
      for (int i = -2; i <= 2; ++i) {
        for (int j = -2; j <= 2; ++j) {
          const double u = std::clamp(cu + width * .5 * i, 0.0, 1.0), v = std::clamp(cv + width * .5 * j, 0.0, 1.0);
          spline::SurfacePoint s;
          skeleton_.surface().evaluate1(u, v, s);
          const double d = skeleton_.radius().evaluate(u, v).f - (p - s.S).norm();
          if (d > most) most = d, bu = u, bv = v;
        }
      }
    }
    return most;
  }

 private:
  static constexpr int kSamples = 80;
  struct Sample {
    Eigen::Vector3d center;
    double radius, u, v;
  };
  const Skeleton& skeleton_;
  std::vector<Sample> samples_;
};

}  // namespace hapticd::medial::test
