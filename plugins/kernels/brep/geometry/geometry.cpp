// SPDX-License-Identifier: MIT
#include "kernels/brep/geometry/geometry.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hapticd::brep {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using spline::CurvePoint;
using spline::SurfacePoint;

/// The profile of a surface of revolution P = o + r(v) e(u) + z(v) z, with first and second derivatives.
struct Profile {
  double r, r1, r2, z, z1, z2;
};

void turn(const Surface& s, double u, const Profile& m, SurfacePoint& out) {
  const double cu = std::cos(u), su = std::sin(u);
  const Vector3d x = vec(s.x), y = vec(s.y), z = vec(s.z);
  const Vector3d e = cu * x + su * y, f = cu * y - su * x;
  out.S = vec(s.o) + m.r * e + m.z * z;
  out.Su = m.r * f;
  out.Sv = m.r1 * e + m.z1 * z;
  out.Suu = -m.r * e;
  out.Suv = m.r1 * f;
  out.Svv = m.r2 * e + m.z2 * z;
}

void plane(const Surface& s, double u, double v, SurfacePoint& out) {
  out.Su = vec(s.x);
  out.Sv = vec(s.y);
  out.S = vec(s.o) + u * out.Su + v * out.Sv;
  out.Suu = out.Suv = out.Svv = Vector3d::Zero();
}

void revolve(const Surface& s, double u, const CurvePoint& c, SurfacePoint& out) {
  const Vector3d axis = vec(s.z), o = vec(s.o);
  const double cu = std::cos(u), su = std::sin(u);
  const auto rotated = [&](const Vector3d& w) {  // Rodrigues' rotation formula
    return Vector3d(cu * w + su * axis.cross(w) + (1 - cu) * axis.dot(w) * axis);
  };
  const Vector3d r = rotated(c.C - o);
  out.S = o + r;
  out.Su = axis.cross(r);
  out.Sv = rotated(c.C1);
  out.Suu = axis.cross(out.Su);
  out.Suv = axis.cross(out.Sv);
  out.Svv = rotated(c.C2);
}

}  // namespace

spline::SurfaceData splineOf(const Part& part, const Surface& surface) {
  spline::SurfaceData data;
  const double* at = part.reals.data() + surface.data;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    data.degree[axis] = static_cast<int>(surface.degree[axis]);
    data.knots[axis].assign(at, at + surface.count[axis] + surface.degree[axis] + 1);
    at += data.knots[axis].size();
  }
  const std::size_t count = std::size_t{surface.count[0]} * surface.count[1];
  data.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i, at += 3) data.points.emplace_back(at[0], at[1], at[2]);
  if ((surface.flags & kRational) != 0) data.weights.assign(at, at + count);
  return data;
}

spline::CurveData splineOf(const Part& part, const Curve3& curve) {
  spline::CurveData data;
  data.degree = static_cast<int>(curve.degree);
  const double* at = part.reals.data() + curve.data;
  data.knots.assign(at, at + curve.count + curve.degree + 1);
  at += data.knots.size();
  for (std::uint32_t i = 0; i < curve.count; ++i, at += 3) data.points.emplace_back(at[0], at[1], at[2]);
  if ((curve.flags & kRational) != 0) data.weights.assign(at, at + curve.count);
  return data;
}

Geometry::Geometry(const Part& part, spline::Form form) : part_(part) {
  for (const Surface& s : part.surfaces) {
    const bool is_spline = s.kind == SurfaceKind::kSpline;
    surface_slot_.push_back(is_spline ? static_cast<std::int32_t>(spline_surfaces_.size()) : -1);
    if (is_spline) spline_surfaces_.emplace_back(splineOf(part, s), form);
  }
  for (const Curve3& c : part.curves3) {
    curve_slot_.push_back(-1);
    if (c.kind != CurveKind::kSpline) continue;
    spline::Curve curve(splineOf(part, c), form);
    const std::uint32_t tabled = table_curves_.add(curve);
    curve_slot_.back() = static_cast<std::int32_t>(tabled);
    if (tabled != TableCurves::kNotTabled) continue;
    curve_slot_.back() = ~static_cast<std::int32_t>(spline_curves_.size());
    spline_curves_.push_back(std::move(curve));
  }
  table_curves_.shrink();
  for (const Curve2& c : part.curves2) {
    const bool is_spline = c.kind == CurveKind::kSpline;
    plane_slot_.push_back(is_spline ? static_cast<std::int32_t>(plane_splines_.size()) : -1);
    if (is_spline) plane_splines_.emplace_back(part, c);
  }
}

void Geometry::surface(std::uint32_t index, double u, double v, SurfacePoint& out) const noexcept {
  const Surface& s = part_.surfaces[index];
  const double r0 = s.r[0], r1 = s.r[1];
  CurvePoint c;
  switch (s.kind) {
    case SurfaceKind::kPlane:
      return plane(s, u, v, out);
    case SurfaceKind::kCylinder:
      return turn(s, u, {r0, 0, 0, v, 1, 0}, out);
    case SurfaceKind::kCone:
      return turn(s, u, {r0 + v * r1, r1, 0, v, 1, 0}, out);
    case SurfaceKind::kSphere: {
      const double cv = r0 * std::cos(v), sv = r0 * std::sin(v);
      return turn(s, u, {cv, -sv, -cv, sv, cv, -sv}, out);
    }
    case SurfaceKind::kTorus: {
      const double cv = r1 * std::cos(v), sv = r1 * std::sin(v);
      return turn(s, u, {r0 + cv, -sv, -cv, sv, cv, -sv}, out);
    }
    case SurfaceKind::kSpline:
      return splineSurface(index).evaluate2(u, v, out);
    case SurfaceKind::kExtrusion:
      curve(s.basis, u, c);
      out.Sv = vec(s.z);
      out.S = c.C + v * out.Sv;
      out.Su = c.C1;
      out.Suu = c.C2;
      out.Suv = out.Svv = Vector3d::Zero();
      return;
    case SurfaceKind::kRevolution:
      curve(s.basis, v, c);
      return revolve(s, u, c, out);
    case SurfaceKind::kOffset:
      return offset(s, u, v, out);
  }
}

/// Evaluates B + d n with n = N / |N|, N = Bu x Bv. The first derivatives follow from the second derivatives of B.
void Geometry::offset(const Surface& s, double u, double v, SurfacePoint& out) const noexcept {
  surface(s.basis, u, v, out);
  const Vector3d N = out.Su.cross(out.Sv);
  const double length = N.norm();
  if (!(length > 0)) return;
  const Vector3d n = N / length;
  const Vector3d Nu = out.Suu.cross(out.Sv) + out.Su.cross(out.Suv);
  const Vector3d Nv = out.Suv.cross(out.Sv) + out.Su.cross(out.Svv);
  const double d = s.r[0];
  out.S += d * n;
  out.Su += d / length * (Nu - n * n.dot(Nu));
  out.Sv += d / length * (Nv - n * n.dot(Nv));
}

void Geometry::curve(std::uint32_t index, double t, CurvePoint& out) const noexcept {
  const Curve3& c = part_.curves3[index];
  if (c.kind == CurveKind::kSpline) {
    const std::int32_t slot = curve_slot_[index];
    if (slot >= 0) return table_curves_.evaluate2(static_cast<std::uint32_t>(slot), t, out);
    return spline_curves_[static_cast<std::size_t>(~slot)].evaluate2(t, out);
  }
  const Vector3d x = vec(c.x);
  if (c.kind == CurveKind::kLine) {
    out.C = vec(c.o) + t * x;
    out.C1 = x;
    out.C2 = Vector3d::Zero();
    return;
  }
  const double ct = std::cos(t), st = std::sin(t);
  const Vector3d y = vec(c.y);
  out.C2 = -(ct * x + st * y);
  out.C = vec(c.o) - out.C2;
  out.C1 = ct * y - st * x;
}

PlanePoint Geometry::planeCurve(std::uint32_t index, double t) const noexcept {
  const Curve2& c = part_.curves2[index];
  if (c.kind == CurveKind::kSpline) {
    const PlaneSplinePoint at = plane_splines_[static_cast<std::size_t>(plane_slot_[index])].at(part_.reals, c, t);
    return {{at.c[0], at.c[1]}, {at.c1[0], at.c1[1]}};
  }
  const Vector2d x = vec(c.x);
  if (c.kind == CurveKind::kLine) return {vec(c.o) + t * x, x};
  const double ct = std::cos(t), st = std::sin(t);
  const Vector2d y = vec(c.y);
  return {vec(c.o) + ct * x + st * y, ct * y - st * x};
}

std::vector<double> Geometry::curveKnots(std::uint32_t index) const {
  if (part_.curves3[index].kind != CurveKind::kSpline) return {};
  const std::int32_t slot = curve_slot_[index];
  if (slot >= 0) return table_curves_.breaks(static_cast<std::uint32_t>(slot));
  const auto breaks = spline_curves_[static_cast<std::size_t>(~slot)].breaks();
  return {breaks.begin(), breaks.end()};
}

std::vector<double> Geometry::planeKnots(std::uint32_t index) const {
  if (plane_slot_[index] < 0) return {};
  return breaksOf(part_, part_.curves2[index]);
}

Vector3d Geometry::normal(const Face& face, const Vector2d& uv) const noexcept {
  constexpr double kVanishing = 1e-9;  // sine of the angle between the tangents
  constexpr double kCollapsed = 1e-7;  // ratio of the two tangents' lengths, each times the range of its parameter
  const Vector2d range = vec(face.hi) - vec(face.lo), inside = 0.5 * (vec(face.hi) + vec(face.lo));
  SurfacePoint at;
  Vector2d where = uv;
  for (double share = 1e-4; share < 0.5; share *= 10) {
    surface(face.surface, where[0], where[1], at);
    const Vector3d n = at.Su.cross(at.Sv);
    const double along_u = at.Su.norm() * range[0], along_v = at.Sv.norm() * range[1];
    const bool collapsed = std::min(along_u, along_v) <= kCollapsed * std::max(along_u, along_v);
    if (!collapsed && n.norm() > kVanishing * at.Su.norm() * at.Sv.norm()) return n.normalized();
    where = uv + share * (inside - uv);
  }
  const Vector3d n = at.Su.cross(at.Sv);
  return n.norm() > 0 ? Vector3d(n.normalized()) : Vector3d::Zero();
}

std::size_t Geometry::bytes() const noexcept {
  std::size_t sum = (surface_slot_.size() + curve_slot_.size() + plane_slot_.size()) * sizeof(std::int32_t);
  for (const auto& s : spline_surfaces_) sum += sizeof s + s.bytes();
  for (const auto& c : spline_curves_) sum += sizeof c + c.bytes();
  return sum + table_curves_.bytes() + plane_splines_.size() * sizeof(PlaneSpline);
}

}  // namespace hapticd::brep
