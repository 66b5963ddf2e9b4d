// SPDX-License-Identifier: MIT
#include "kernels/brep/elements/feet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hapticd::brep {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

/// Moves a parameter by whole periods to within half a period of the middle of the face.
double wrapped(double u, double middle, double period) noexcept {
  return period > 0 ? u - period * std::floor((u - middle) / period + 0.5) : u;
}

/// A probe in cylindrical coordinates around the axis of a face.
struct AboutAxis {
  double a, b, height, radius;
  AboutAxis(const FaceShape& f, const Vector3d& p) noexcept {
    const Vector3d w = p - f.o;
    a = w.dot(f.x);
    b = w.dot(f.y);
    height = w.dot(f.z);
    radius = std::sqrt(a * a + b * b);
  }
  /// Unit radial direction. On the axis, where it is not defined, the direction at the face's middle.
  Vector3d radial(const FaceShape& f) const noexcept {
    if (radius > 0) return (a * f.x + b * f.y) / radius;
    return f.nappe * (std::cos(f.middle[0]) * f.x + std::sin(f.middle[0]) * f.y);
  }
  double angle(const FaceShape& f) const noexcept {
    if (!(radius > 0)) return f.middle[0];
    const double u = std::atan2(f.nappe * b, f.nappe * a);
    return wrapped(u, f.middle[0], f.period[0]);
  }
};

constexpr double kNothing = std::numeric_limits<double>::infinity();

/// Moves u by whole turns until (u, v) is inside the loops of a face that winds around its axis more than once, such as
/// a thread. Returns false if it is inside for none of these u.
bool findTurn(const FaceShape& f, double& u, double v) noexcept {
  constexpr int kMostTurns = 256;
  const double period = f.period[0], lo = f.trim.lo()[0], hi = f.trim.hi()[0];
  if (!(period > 0 && hi - lo > period)) return false;
  double turn = u - period * std::floor((u - lo) / period);
  for (int i = 0; i < kMostTurns && turn <= hi; ++i, turn += period) {
    if (!f.trim.inside(turn, v)) continue;
    u = turn;
    return true;
  }
  return false;
}

double take(const FaceShape& f, double u, double v, double d2, const Vector3d& point, Hit& hit) noexcept {
  if (!f.trim.inside(u, v) && !findTurn(f, u, v)) return kNothing;
  hit.d2 = d2;
  hit.point = point;
  hit.u = u;
  hit.v = v;
  return d2;
}

double planeFoot(const FaceShape& f, const Vector3d& p, Hit& hit) noexcept {
  const Vector3d w = p - f.o;
  const double h = w.dot(f.z);
  if (!(h * h < hit.d2)) return h * h;
  return take(f, w.dot(f.x) * f.per_x, w.dot(f.y) * f.per_y, h * h, p - h * f.z, hit);
}

double cylinderFoot(const FaceShape& f, const Vector3d& p, Hit& hit) noexcept {
  const AboutAxis at(f, p);
  const double d = at.radius - f.r0;
  if (!(d * d < hit.d2)) return d * d;
  return take(f, at.angle(f), at.height * f.per_y, d * d, p - d * at.radial(f), hit);
}

/// Foot on a cone. In the half-plane through the axis the cone is a line: radius r0 + r1 s at height `rise` s. On the
/// far nappe the radius is negative.
double coneFoot(const FaceShape& f, const Vector3d& p, Hit& hit) noexcept {
  const AboutAxis at(f, p);
  const double out = f.nappe * at.radius - f.r0;
  const double d = out * f.rise - at.height * f.r1;
  if (!(d * d < hit.d2)) return d * d;
  const double s = out * f.r1 + at.height * f.rise;
  const Vector3d point = f.o + (f.r0 + f.r1 * s) * f.nappe * at.radial(f) + f.rise * s * f.z;
  return take(f, at.angle(f), s * f.per_y, d * d, point, hit);
}

double sphereFoot(const FaceShape& f, const Vector3d& p, Hit& hit) noexcept {
  // the trim test is half-open: at the pole itself it would say "outside"
  constexpr double kPole = std::numbers::pi / 2 - 1e-12;
  const AboutAxis at(f, p);
  const double length = std::sqrt(at.radius * at.radius + at.height * at.height), d = length - f.r0;
  if (!(d * d < hit.d2)) return d * d;
  const double v = length > 0 ? std::atan2(at.height, at.radius) : f.middle[1];
  const Vector3d away =
      length > 0 ? Vector3d((p - f.o) / length) : Vector3d(std::cos(v) * at.radial(f) + std::sin(v) * f.z);
  return take(f, at.angle(f), std::clamp(v, -kPole, kPole), d * d, f.o + f.r0 * away, hit);
}

/// Foot on a torus. In the half-plane through the axis the torus is a circle about radius r0. If the face is where a
/// spindle torus has a negative radius, the half-plane behind the axis is used.
double torusFoot(const FaceShape& f, const Vector3d& p, Hit& hit) noexcept {
  const AboutAxis at(f, p);
  const double out = f.nappe * at.radius - f.r0;
  const double length = std::sqrt(out * out + at.height * at.height), d = length - f.r1;
  if (!(d * d < hit.d2)) return d * d;
  double v = f.middle[1], across = std::cos(v), along = std::sin(v);
  if (length > 0) {
    v = wrapped(std::atan2(at.height, out), f.middle[1], f.period[1]);
    across = out / length;
    along = at.height / length;
  }
  const Vector3d point = f.o + (f.r0 + f.r1 * across) * f.nappe * at.radial(f) + f.r1 * along * f.z;
  return take(f, at.angle(f), v, d * d, point, hit);
}

/// Returns -1 if the radius is negative in the middle of a face, else 1.
double nappeOf(const Surface& s, const Array2d& middle) {
  if (s.kind == SurfaceKind::kCone) return s.r[0] + middle[1] * s.r[1] < 0 ? -1 : 1;
  if (s.kind == SurfaceKind::kTorus) return s.r[0] + s.r[1] * std::cos(middle[1]) < 0 ? -1 : 1;
  return 1;
}

}  // namespace

FaceShape faceShape(const Geometry& geometry, std::uint32_t index) {
  const Face& face = geometry.part().faces[index];
  const Surface& s = geometry.part().surfaces[face.surface];
  FaceShape f;
  f.kind = s.kind;
  f.trim = Trim(geometry, face);
  f.middle = 0.5 * (vec(face.lo) + vec(face.hi)).array();
  f.period = Array2d(s.period[0], s.period[1]);
  f.o = vec(s.o);
  f.x = vec(s.x).normalized();
  f.y = vec(s.y).normalized();
  f.nappe = nappeOf(s, f.middle);
  f.r0 = s.r[0];
  f.r1 = s.r[1];
  f.outward = (face.flags & kReversed) != 0 ? -1 : 1;
  if (s.kind == SurfaceKind::kPlane) {
    f.z = f.x.cross(f.y).normalized();
    f.per_x = 1 / vec(s.x).norm();
    f.per_y = 1 / vec(s.y).norm();
    return f;
  }
  const double length = vec(s.z).norm();
  f.z = vec(s.z) / length;
  f.per_y = 1 / length;
  if (f.x.cross(f.y).dot(f.z) < 0) f.outward = -f.outward;
  if (s.kind == SurfaceKind::kCone) {
    const double slant = std::hypot(s.r[1], length);
    f.r1 = s.r[1] / slant;
    f.rise = length / slant;
    f.per_y = 1 / slant;
  }
  return f;
}

EdgeShape edgeShape(const Part& part, const Edge& edge) {
  const Curve3& c = part.curves3[edge.curve];
  EdgeShape e;
  e.o = vec(c.o);
  e.t0 = edge.t0;
  e.t1 = edge.t1;
  e.size = vec(c.x).norm();
  e.x = vec(c.x) / e.size;
  if (c.kind != CurveKind::kLine) e.y = vec(c.y).normalized();
  return e;
}

double faceFoot(const FaceShape& face, const Vector3d& p, Hit& hit) noexcept {
  switch (face.kind) {
    case SurfaceKind::kPlane:
      return planeFoot(face, p, hit);
    case SurfaceKind::kCylinder:
      return cylinderFoot(face, p, hit);
    case SurfaceKind::kCone:
      return coneFoot(face, p, hit);
    case SurfaceKind::kSphere:
      return sphereFoot(face, p, hit);
    case SurfaceKind::kTorus:
      return torusFoot(face, p, hit);
    default:
      return kNothing;
  }
}

double lineFoot(const EdgeShape& e, const Vector3d& p, Hit& hit) noexcept {
  const double free = (p - e.o).dot(e.x) / e.size;
  const double t = std::clamp(free, e.t0, e.t1);
  const Vector3d point = e.o + t * e.size * e.x;
  const double d2 = (p - point).squaredNorm();
  if (!(d2 < hit.d2)) return d2;
  hit.d2 = d2;
  hit.point = point;
  hit.u = t;
  hit.region = static_cast<std::uint8_t>(free <= e.t0   ? EdgeRegion::kFirst
                                         : free >= e.t1 ? EdgeRegion::kLast
                                                        : EdgeRegion::kInside);
  return d2;
}

double circleFoot(const EdgeShape& e, const Vector3d& p, Hit& hit) noexcept {
  constexpr double kTurn = 2 * std::numbers::pi;
  const Vector3d w = p - e.o;
  const double a = w.dot(e.x), b = w.dot(e.y), radius = std::sqrt(a * a + b * b);
  const double off = w.dot(e.x.cross(e.y)), out = radius - e.size;
  const double whole = off * off + out * out;
  // even the nearest point of the full circle is farther
  if (!(whole < hit.d2 * (1 + 1e-9))) return whole * (1 - 1e-9);
  double t = e.t0;
  EdgeRegion region = EdgeRegion::kInside;
  Vector3d direction = std::cos(t) * e.x + std::sin(t) * e.y;
  if (radius > 0) {
    const double angle = std::atan2(b, a);
    t = angle + kTurn * std::ceil((e.t0 - angle) / kTurn);  // the first angle at or after t0
    if (t <= e.t1) {
      direction = (a * e.x + b * e.y) / radius;
    } else {
      region = t - e.t1 <= e.t0 + kTurn - t ? EdgeRegion::kLast : EdgeRegion::kFirst;
      t = region == EdgeRegion::kLast ? e.t1 : e.t0;
      direction = std::cos(t) * e.x + std::sin(t) * e.y;
    }
  }
  const Vector3d point = e.o + e.size * direction;
  const double d2 = (p - point).squaredNorm();
  if (!(d2 < hit.d2)) return d2;
  hit.d2 = d2;
  hit.point = point;
  hit.u = t;
  hit.region = static_cast<std::uint8_t>(region);
  return d2;
}

Vector3d faceNormal(const FaceShape& f, const Vector3d& q) noexcept {
  if (f.kind == SurfaceKind::kPlane) return f.outward * f.z;
  const AboutAxis at(f, q);
  const Vector3d radial = f.nappe * at.radial(f);  // direction in which the signed radius grows
  switch (f.kind) {
    case SurfaceKind::kCone:
      return f.outward * f.nappe * (f.rise * radial - f.r1 * f.z);
    case SurfaceKind::kSphere:
      return f.outward * (q - f.o).normalized();
    case SurfaceKind::kTorus: {
      const double across = (f.nappe * at.radius - f.r0) / f.r1, along = at.height / f.r1;
      return f.outward * f.nappe * (across * radial + along * f.z).normalized();
    }
    default:
      return f.outward * radial;
  }
}

}  // namespace hapticd::brep
