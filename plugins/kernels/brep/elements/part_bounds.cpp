// SPDX-License-Identifier: MIT
#include "kernels/brep/elements/part_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hapticd::brep {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The least and largest values of a cos t + b sin t on [t0, t1].
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

/// Bounds of the radius and the height of a face of revolution.
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

AlignedBox3d rounded(const Vector3d& least, const Vector3d& most) {
  const Vector3d rounding = Vector3d::Constant(1e-13 * (least.cwiseAbs() + most.cwiseAbs()).maxCoeff());
  return {least - rounding, most + rounding};
}

/// Returns unit axes at right angles as rows: the first along `a`, the second near `b`.
Matrix3d frameOf(const Vector3d& a, const Vector3d& b) {
  Matrix3d frame;
  frame.row(0) = a.normalized();
  frame.row(2) = a.cross(b).normalized();
  frame.row(1) = Vector3d(frame.row(2)).cross(Vector3d(frame.row(0))).normalized();
  return frame;
}

}  // namespace

AlignedBox3d faceBox(const FaceShape& f, const Matrix3d& frame) {
  const Eigen::Array2d lo = f.trim.lo(), hi = f.trim.hi();
  const Vector3d o = frame * f.o, x = frame * f.x, y = frame * f.y, z = frame * f.z;
  AlignedBox3d box;
  if (f.kind == SurfaceKind::kPlane) {
    for (const double u : {lo[0], hi[0]})
      for (const double v : {lo[1], hi[1]}) box.extend(o + u / f.per_x * x + v / f.per_y * y);
    return box;
  }
  const ProfileBounds profile = profileOf(f, lo[1], hi[1]);
  Vector3d least, most;
  for (int axis = 0; axis < 3; ++axis) {
    const Range wave = waveRange(x[axis], y[axis], lo[0], hi[0]);
    const double products[] = {wave.least * profile.radius.least, wave.least * profile.radius.most,
                               wave.most * profile.radius.least, wave.most * profile.radius.most};
    const double low = z[axis] * profile.height.least, high = z[axis] * profile.height.most;
    least[axis] = o[axis] + *std::min_element(products, products + 4) + std::min(low, high);
    most[axis] = o[axis] + *std::max_element(products, products + 4) + std::max(low, high);
  }
  return rounded(least, most);
}

OrientedBox orientedFaceBox(const FaceShape& f) {
  const double middle = 0.5 * (f.trim.lo()[0] + f.trim.hi()[0]);
  OrientedBox oriented;
  oriented.frame = f.kind == SurfaceKind::kPlane ? frameOf(f.x, f.y)
                                                 : frameOf(std::cos(middle) * f.x + std::sin(middle) * f.y,
                                                           std::cos(middle) * f.y - std::sin(middle) * f.x);
  oriented.box = faceBox(f, oriented.frame);
  return oriented;
}

AlignedBox3d edgeBox(const EdgeShape& e, bool circle, const Matrix3d& frame) {
  const Vector3d o = frame * e.o, x = frame * e.x, y = frame * e.y;
  AlignedBox3d box;
  if (!circle) {
    box.extend(o + e.t0 * e.size * x);
    box.extend(o + e.t1 * e.size * x);
    return box;
  }
  Vector3d least, most;
  for (int axis = 0; axis < 3; ++axis) {
    const Range wave = waveRange(x[axis], y[axis], e.t0, e.t1);
    least[axis] = o[axis] + e.size * wave.least;
    most[axis] = o[axis] + e.size * wave.most;
  }
  return rounded(least, most);
}

OrientedBox orientedEdgeBox(const EdgeShape& e, bool circle) {
  const double middle = 0.5 * (e.t0 + e.t1);
  OrientedBox oriented;
  oriented.frame =
      circle ? frameOf(std::cos(middle) * e.x + std::sin(middle) * e.y, std::cos(middle) * e.y - std::sin(middle) * e.x)
             : frameOf(e.x, e.x.unitOrthogonal());
  oriented.box = edgeBox(e, circle, oriented.frame);
  return oriented;
}

}  // namespace hapticd::brep
