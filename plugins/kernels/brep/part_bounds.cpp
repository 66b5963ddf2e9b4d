// SPDX-License-Identifier: MIT
#include "kernels/brep/part_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hapticd::brep {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// Least and largest value of a cos t + b sin t on [t0, t1].
struct Range {
  double least, most;
};
Range waveRange(double a, double b, double t0, double t1) {
  const auto at = [&](double t) { return a * std::cos(t) + b * std::sin(t); };
  Range range{std::min(at(t0), at(t1)), std::max(at(t0), at(t1))};
  const double size = std::hypot(a, b), top = std::atan2(b, a), turn = 2 * std::numbers::pi;
  const auto holds = [&](double t) { return t + turn * std::ceil((t0 - t) / turn) <= t1; };
  if (holds(top)) range.most = size;
  if (holds(top + std::numbers::pi)) range.least = -size;
  return range;
}

/// The extremes of radius and height of a face of revolution.
struct ProfileBounds {
  Range radius, height;
};
ProfileBounds profileOf(const FaceShape& f, double v0, double v1) {
  switch (f.kind) {
    case SurfaceKind::kCone: {
      const double s0 = v0 / f.per_y, s1 = v1 / f.per_y;
      const double a = f.r0 + f.r1 * s0, b = f.r0 + f.r1 * s1;
      return {{std::min(a, b), std::max(a, b)}, {f.rise * s0, f.rise * s1}};
    }
    case SurfaceKind::kSphere: {
      const Range r = waveRange(f.r0, 0, v0, v1), h = waveRange(0, f.r0, v0, v1);
      return {r, h};
    }
    case SurfaceKind::kTorus: {
      const Range r = waveRange(f.r1, 0, v0, v1);
      return {{f.r0 + r.least, f.r0 + r.most}, waveRange(0, f.r1, v0, v1)};
    }
    default:
      return {{f.r0, f.r0}, {v0 / f.per_y, v1 / f.per_y}};
  }
}

}  // namespace

AlignedBox3d faceBox(const FaceShape& f) {
  const Eigen::Array2d lo = f.trim.lo(), hi = f.trim.hi();
  AlignedBox3d box;
  if (f.kind == SurfaceKind::kPlane) {
    for (const double u : {lo[0], hi[0]})
      for (const double v : {lo[1], hi[1]}) box.extend(f.o + u / f.per_x * f.x + v / f.per_y * f.y);
    return box;
  }
  const ProfileBounds profile = profileOf(f, lo[1], hi[1]);
  Vector3d least, most;
  for (int axis = 0; axis < 3; ++axis) {
    const Range wave = waveRange(f.x[axis], f.y[axis], lo[0], hi[0]);
    const double products[] = {wave.least * profile.radius.least, wave.least * profile.radius.most,
                               wave.most * profile.radius.least, wave.most * profile.radius.most};
    const double low = f.z[axis] * profile.height.least, high = f.z[axis] * profile.height.most;
    least[axis] = f.o[axis] + *std::min_element(products, products + 4) + std::min(low, high);
    most[axis] = f.o[axis] + *std::max_element(products, products + 4) + std::max(low, high);
  }
  const Vector3d rounding = Vector3d::Constant(1e-13 * (least.cwiseAbs() + most.cwiseAbs()).maxCoeff());
  return {least - rounding, most + rounding};
}

AlignedBox3d edgeBox(const EdgeShape& e, bool circle) {
  AlignedBox3d box;
  if (!circle) {
    box.extend(e.o + e.t0 * e.size * e.x);
    box.extend(e.o + e.t1 * e.size * e.x);
    return box;
  }
  Vector3d least, most;
  for (int axis = 0; axis < 3; ++axis) {
    const Range wave = waveRange(e.x[axis], e.y[axis], e.t0, e.t1);
    least[axis] = e.o[axis] + e.size * wave.least;
    most[axis] = e.o[axis] + e.size * wave.most;
  }
  const Vector3d rounding = Vector3d::Constant(1e-13 * (least.cwiseAbs() + most.cwiseAbs()).maxCoeff());
  return {least - rounding, most + rounding};
}

}  // namespace hapticd::brep
