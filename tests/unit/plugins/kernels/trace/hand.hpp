// SPDX-License-Identifier: MIT
/// A hand that feels a model, with the search that runs beside it.
#pragma once
#include <algorithm>
#include <limits>

#include "kernels/trace/tracer.hpp"

namespace hapticd::trace {

inline TraceOptions holding(contact::Sides sides = contact::Sides::kFront,
                            double hysteresis = std::numeric_limits<double>::infinity()) {
  TraceOptions options;
  options.rule = {sides, hysteresis};
  options.unite = sides == contact::Sides::kFront;
  return options;
}

/// A bilinear patch whose Su x Sv points as (b - a) x (c - a).
inline spline::SurfaceData flat(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  spline::SurfaceData data;
  data.knots = {{{0, 0, 1, 1}, {0, 0, 1, 1}}};
  data.points = {a, c, b, b + c - a};
  return data;
}

/// A tracer with the search that runs beside it, each fifth tick.
struct Hand {
  const Model& model;
  Tracer tracer{model};
  TraceOptions options = holding();
  int tick = 0;

  Foot at(const Eigen::Vector3d& p) {
    if (tick++ % 5 == 0) {
      Found found;
      model.search(p, 0.15, found);
      for (const auto* records : {&found.nearest, &found.rivals})
        for (const Near& near : *records) tracer.activate(near.surface, near.u, near.v, near.distance);
    }
    return tracer.step(p, options);
  }
  /// Straight from a to b in steps of about `step` [m].
  template <class See>
  void walk(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double step, const See& see) {
    const int count = std::max(1, static_cast<int>((b - a).norm() / step));
    for (int i = 0; i <= count; ++i) {
      const Eigen::Vector3d p = a + (b - a) * i / count;
      see(at(p), p);
    }
  }
};

}  // namespace hapticd::trace
