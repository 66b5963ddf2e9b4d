// SPDX-License-Identifier: MIT
#include "cad_import/recognition.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <algorithm>
#include <cmath>
#include <vector>

namespace hapticd::cad {
namespace {

using brep::Surface;
using brep::SurfaceKind;
using brep::Vector2;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFarthestOff = 1e-9;  ///< [m] largest distance of a point from a recognised surface

Vector3d inMetres(const gp_XYZ& v) {
  return Vector3d(v.X(), v.Y(), v.Z()) * kMetres;
}
Vector3d vec(const brep::Vector& v) {
  return {v[0], v[1], v[2]};
}
brep::Vector plain(const Vector3d& v) {
  return {v[0], v[1], v[2]};
}

/// Sample points and normals of a surface.
struct Cloud {
  std::vector<Vector3d> points, normals;
  Vector3d middle{0, 0, 0};  ///< a point in the middle of the surface
};

/// Samples an even grid over [lo, hi]. Returns an empty cloud if the surface has no normal at one of its points.
Cloud sampled(const Handle(Geom_Surface) & surface, const Vector2& lo, const Vector2& hi) {
  constexpr int kAcross = 17;
  Cloud cloud;
  for (int i = 0; i < kAcross; ++i)
    for (int j = 0; j < kAcross; ++j) {
      gp_Pnt p;
      gp_Vec du, dv;
      surface->D1(lo[0] + (hi[0] - lo[0]) * (i + 0.5) / kAcross, lo[1] + (hi[1] - lo[1]) * (j + 0.5) / kAcross, p, du,
                  dv);
      const Vector3d n = inMetres(du.XYZ()).cross(inMetres(dv.XYZ()));
      const double length = n.norm();
      if (!(length > 1e-9 * inMetres(du.XYZ()).norm() * inMetres(dv.XYZ()).norm()) || !(length > 0)) return {};
      cloud.points.push_back(inMetres(p.XYZ()));
      cloud.normals.push_back(n / length);
    }
  cloud.middle = cloud.points[cloud.points.size() / 2];
  return cloud;
}

Vector3d mean(const std::vector<Vector3d>& v) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

/// Returns the direction along which the vectors have the least spread about `about` (principal component analysis).
Vector3d flattest(const std::vector<Vector3d>& v, const Vector3d& about) {
  Matrix3d spread = Matrix3d::Zero();
  for (const Vector3d& x : v) spread += (x - about) * (x - about).transpose();
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(spread).eigenvectors().col(0);
}

Surface frame(SurfaceKind kind, const Vector3d& o, const Vector3d& z, const Vector3d& toward, bool left_handed) {
  Surface s;
  s.kind = kind;
  const Vector3d across = toward - z.dot(toward) * z;
  const Vector3d x = across.norm() > 1e-12 ? Vector3d(across.normalized()) : Vector3d(z.unitOrthogonal());
  const Vector3d y = left_handed ? x.cross(z) : z.cross(x);
  s.o = plain(o);
  s.x = plain(x);
  s.y = plain(y.normalized());
  s.z = plain(z);
  return s;
}

std::optional<Surface> planeOf(const Handle(Geom_BSplineSurface) & spline, const Cloud& cloud) {
  const Vector3d n = mean(cloud.normals).normalized();
  for (int i = 1; i <= spline->NbUPoles(); ++i)
    for (int j = 1; j <= spline->NbVPoles(); ++j)
      if (std::abs(n.dot(inMetres(spline->Pole(i, j).XYZ()) - cloud.middle)) > kFarthestOff) return {};
  for (const Vector3d& normal : cloud.normals)
    if (normal.dot(n) < 0) return {};
  Surface s = frame(SurfaceKind::kPlane, cloud.middle, n, n.unitOrthogonal(), false);
  s.x = plain(vec(s.x) * kMetres);
  s.y = plain(vec(s.y) * kMetres);
  return s;
}

/// Finds the centre c and the radius r with P = c + r n for all points P with normals n, by least squares. Only the
/// directions onto which `keep` projects count. Returns false if there is no solution.
bool center(const Cloud& cloud, const Matrix3d& keep, Vector3d& c, double& r) {
  const Vector3d p0 = mean(cloud.points), n0 = mean(cloud.normals);
  double pn = 0, nn = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vector3d n = keep * (cloud.normals[i] - n0);
    pn += n.dot(cloud.points[i] - p0);
    nn += n.squaredNorm();
  }
  if (!(nn > 1e-12)) return false;
  r = pn / nn;
  c = p0 - r * n0;
  return true;
}

std::optional<Surface> cylinderOf(const Cloud& cloud) {
  const Vector3d axis = flattest(cloud.normals, Vector3d::Zero());
  const Matrix3d across = Matrix3d::Identity() - axis * axis.transpose();
  Vector3d c;
  double r = 0;
  if (!center(cloud, across, c, r) || !(std::abs(r) < 1e3)) return {};
  for (const Vector3d& p : cloud.points)
    if (std::abs((across * (p - c)).norm() - std::abs(r)) > kFarthestOff) return {};
  Surface s = frame(SurfaceKind::kCylinder, c, axis, cloud.middle - c, r < 0);
  s.z = plain(axis * kMetres);
  s.r[0] = std::abs(r);
  s.period[0] = kFullTurn;
  return s;
}

std::optional<Surface> sphereOf(const Cloud& cloud) {
  Vector3d c;
  double r = 0;
  if (!center(cloud, Matrix3d::Identity(), c, r) || !(std::abs(r) < 1e3)) return {};
  for (const Vector3d& p : cloud.points)
    if (std::abs((p - c).norm() - std::abs(r)) > kFarthestOff) return {};
  const Vector3d toward = (cloud.middle - c).normalized();  // puts poles and seam as far from the face as possible
  Surface s = frame(SurfaceKind::kSphere, c, toward.unitOrthogonal(), toward, r < 0);
  s.r[0] = std::abs(r);
  s.period[0] = kFullTurn;
  return s;
}

std::optional<Surface> coneOf(const Cloud& cloud) {
  const Vector3d n0 = mean(cloud.normals);
  Vector3d axis = flattest(cloud.normals, n0);
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    A += cloud.normals[i] * cloud.normals[i].transpose();
    b += cloud.normals[i] * cloud.normals[i].dot(cloud.points[i]);
  }
  const Vector3d apex = A.ldlt().solve(b);
  if (!apex.allFinite()) return {};
  if (axis.dot(cloud.middle - apex) < 0) axis = -axis;
  const Vector3d way = cloud.middle - apex;
  const double height = axis.dot(way), wide = (way - height * axis).norm(), slant = std::hypot(height, wide);
  if (!(slant > 0) || !(wide > 1e-3 * slant) || !(height > 1e-3 * slant)) return {};
  const double ca = height / slant, sa = wide / slant;
  for (const Vector3d& p : cloud.points) {
    const double h = axis.dot(p - apex), w = (p - apex - h * axis).norm();
    if (std::abs(w * ca - h * sa) > kFarthestOff || h <= 0) return {};
  }
  const Vector3d out = (way - height * axis).normalized() * ca - axis * sa;
  Surface s =
      frame(SurfaceKind::kCone, apex + height * axis, axis, way, out.dot(cloud.normals[cloud.normals.size() / 2]) < 0);
  s.z = plain(axis * (kMetres * ca));
  s.r = {wide, kMetres * sa};
  s.period[0] = kFullTurn;
  return s;
}

/// Returns (u, v) of a point near the surface, with the u that is nearest to `near_u`.
Vector2d parametersOf(const Surface& s, const Vector3d& p, double near_u) {
  const Vector3d d = p - vec(s.o), x = vec(s.x), y = vec(s.y), z = vec(s.z);
  if (s.kind == SurfaceKind::kPlane) return {d.dot(x) / x.squaredNorm(), d.dot(y) / y.squaredNorm()};
  double u = std::atan2(d.dot(y), d.dot(x));
  u += kFullTurn * std::round((near_u - u) / kFullTurn);
  if (s.kind == SurfaceKind::kSphere) return {u, std::atan2(d.dot(z), std::hypot(d.dot(x), d.dot(y)))};
  return {u, d.dot(z) / z.squaredNorm()};
}

/// A point of a surface and its two tangents.
struct Tangents {
  Vector3d p, u, v;
};

Tangents tangentsAt(const Surface& s, const Vector2d& uv) {
  const Vector3d o = vec(s.o), x = vec(s.x), y = vec(s.y), z = vec(s.z);
  if (s.kind == SurfaceKind::kPlane) return {o + uv[0] * x + uv[1] * y, x, y};
  const double cu = std::cos(uv[0]), su = std::sin(uv[0]);
  const Vector3d e = cu * x + su * y, f = cu * y - su * x;
  if (s.kind == SurfaceKind::kSphere) {
    const double cv = s.r[0] * std::cos(uv[1]), sv = s.r[0] * std::sin(uv[1]);
    return {o + cv * e + sv * z, cv * f, cv * z - sv * e};
  }
  const double slope = s.kind == SurfaceKind::kCone ? s.r[1] : 0, r = s.r[0] + slope * uv[1];
  return {o + r * e + uv[1] * z, r * f, slope * e + z};
}

/// Projects a curve in space onto a plane, along the normal. This is exact for all kinds of curves.
brep::Curve2 projected(const brep::Curve3& c, const Surface& s, brep::Part& part) {
  const auto seen = [&](const Vector3d& w) {
    const Vector3d x = vec(s.x), y = vec(s.y);
    return Vector2{w.dot(x) / x.squaredNorm(), w.dot(y) / y.squaredNorm()};
  };
  brep::Curve2 flat;
  flat.kind = c.kind == brep::CurveKind::kCircle ? brep::CurveKind::kEllipse : c.kind;
  flat.o = seen(vec(c.o) - vec(s.o));
  flat.x = seen(vec(c.x));
  flat.y = seen(vec(c.y));
  if (c.kind == brep::CurveKind::kCircle &&
      std::abs(std::hypot(flat.x[0], flat.x[1]) - std::hypot(flat.y[0], flat.y[1])) <
          1e-12 * std::hypot(flat.x[0], flat.x[1]))
    flat.kind = brep::CurveKind::kCircle;
  if (c.kind != brep::CurveKind::kSpline) return flat;
  flat = brep::Curve2{};
  flat.kind = c.kind;
  flat.flags = c.flags;
  flat.degree = c.degree;
  flat.count = c.count;
  flat.data = part.reals.size();
  const std::size_t knots = std::size_t{c.count} + c.degree + 1;
  std::vector<double> reals(part.reals.begin() + static_cast<std::ptrdiff_t>(c.data),
                            part.reals.begin() + static_cast<std::ptrdiff_t>(c.data + knots));
  const double* at = part.reals.data() + c.data + knots;
  for (std::uint32_t i = 0; i < c.count; ++i, at += 3)
    for (const double value : seen(Vector3d(at[0], at[1], at[2]) - vec(s.o))) reals.push_back(value);
  if ((c.flags & brep::kRational) != 0) reals.insert(reals.end(), at, at + c.count);
  part.reals.insert(part.reals.end(), reals.begin(), reals.end());
  return flat;
}

}  // namespace

std::optional<Surface> recognised(const Handle(Geom_Surface) & surface, const Vector2& lo, const Vector2& hi) {
  const auto spline = Handle(Geom_BSplineSurface)::DownCast(surface);
  if (spline.IsNull()) return {};
  const Cloud cloud = sampled(surface, lo, hi);
  if (cloud.points.empty()) return {};
  if (auto plane = planeOf(spline, cloud)) return plane;
  if (auto cylinder = cylinderOf(cloud)) return cylinder;
  if (auto sphere = sphereOf(cloud)) return sphere;
  return coneOf(cloud);
}

Unfolding::Unfolding(const Handle(Geom_Surface) & surface, const Vector2& lo, const Vector2& hi, const Surface& shape)
    : surface_(surface), middle_{0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1])}, shape_(shape) {}

void Unfolding::widen(const Vector2& uv) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    lo_[axis] = std::min(lo_[axis], uv[axis]);
    hi_[axis] = std::max(hi_[axis], uv[axis]);
  }
}

/// Returns the angle u at a point given by the spline's parameters, without jumps of a full turn along the way from the
/// middle of the face.
double Unfolding::angleAt(const gp_Pnt2d& uv) const {
  constexpr int kSteps = 64;
  double u = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    const gp_Pnt p =
        surface_->Value(middle_[0] + share * (uv.X() - middle_[0]), middle_[1] + share * (uv.Y() - middle_[1]));
    u = parametersOf(shape_, inMetres(p.XYZ()), u)[0];
  }
  return u;
}

namespace {

constexpr int kSpans = 64;  ///< number of spans of the spline that follows an edge in the parameter plane

/// Returns the line in the parameter plane that is at `a` for t = t0 and at `b` for t = t1.
brep::Curve2 lineBetween(const Vector2& a, const Vector2& b, double t0, double t1) {
  brep::Curve2 line;
  for (std::size_t k = 0; k < 2; ++k) {
    line.x[k] = (b[k] - a[k]) / (t1 - t0);
    line.o[k] = a[k] - t0 * line.x[k];
  }
  return line;
}

/// Builds a spline of cubics with the points and slopes of the edge. Its error is h^4 / 384 times the fourth
/// derivative.
template <class Sample>
brep::Curve2 cubicsThrough(const std::vector<Sample>& samples, double t0, double t1, brep::Part& part) {
  brep::Curve2 spline;
  spline.kind = brep::CurveKind::kSpline;
  spline.degree = 3;
  spline.count = 2 * (kSpans + 1);
  spline.data = part.reals.size();
  part.reals.insert(part.reals.end(), 2, t0);
  for (const Sample& s : samples) part.reals.insert(part.reals.end(), 2, s.t);
  part.reals.insert(part.reals.end(), 2, samples.back().t);
  const double third = (t1 - t0) / kSpans / 3;
  for (int i = 0; i <= kSpans; ++i) {
    const Sample& s = samples[static_cast<std::size_t>(i)];
    const double before = i == 0 ? 0 : -third, after = i == kSpans ? 0 : third;
    for (const double step : {before, after})
      for (std::size_t k = 0; k < 2; ++k) part.reals.push_back(s.uv[k] + step * s.slope[k]);
  }
  return spline;
}

}  // namespace

Unfolding::Sample Unfolding::sampleAt(const Handle(Geom_Curve) & curve, double t, double near_u, double within) const {
  gp_Pnt p;
  gp_Vec d;
  curve->D1(t, p, d);
  const Vector3d point = inMetres(p.XYZ()), way = inMetres(d.XYZ());
  const Vector2d uv = parametersOf(shape_, point, near_u);
  const Tangents at = tangentsAt(shape_, uv);
  if (!((at.p - point).norm() <= within)) throw Unkept("an edge leaves it");
  const double uu = at.u.squaredNorm(), vv = at.v.squaredNorm();
  constexpr double kPole = 1e-12;  // square of the share of a radius; nearer to the axis, the angle is rounding error
  if (!(uu > kPole * vv)) return {t, {near_u, uv[1]}, {0, 0}, true};
  // divided separately, because the tangents along u and v are at right angles
  return {t, {uv[0], uv[1]}, {way.dot(at.u) / uu, way.dot(at.v) / vv}, false};
}

/// Samples an edge over [t0, t1]; u is followed from `uv`, the point at t, to both ends.
std::vector<Unfolding::Sample> Unfolding::samplesAlong(const Handle(Geom_Curve) & curve, double t0, double t1,
                                                       const gp_Pnt2d& uv, double t, double within) const {
  std::vector<Sample> samples(kSpans + 1);
  const auto at = [&](int i) { return t0 + (t1 - t0) * i / kSpans; };
  const int anchor = std::clamp(static_cast<int>(std::lround((t - t0) / (t1 - t0) * kSpans)), 0, kSpans);
  double u = angleAt(uv);
  for (int i = anchor; i <= kSpans; ++i)
    u = (samples[static_cast<std::size_t>(i)] = sampleAt(curve, at(i), u, within)).uv[0];
  u = samples[static_cast<std::size_t>(anchor)].uv[0];
  for (int i = anchor - 1; i >= 0; --i)
    u = (samples[static_cast<std::size_t>(i)] = sampleAt(curve, at(i), u, within)).uv[0];
  return samples;
}

/// Returns true if an edge touches a pole of the surface, or passes it between two samples.
bool Unfolding::runsToAPole(const std::vector<Sample>& samples) {
  constexpr double kJump = kFullTurn / 12;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i].pole || (i > 0 && std::abs(samples[i].uv[0] - samples[i - 1].uv[0]) > kJump)) return true;
  return false;
}

/// Returns true if a line in the parameter plane follows the edge.
bool Unfolding::follows(const brep::Curve2& line, const std::vector<Sample>& samples) const {
  return std::all_of(samples.begin(), samples.end(), [&](const Sample& s) {
    const Tangents there = tangentsAt(shape_, Vector2d(s.uv[0], s.uv[1]));
    const Vector2d off(s.uv[0] - line.o[0] - s.t * line.x[0], s.uv[1] - line.o[1] - s.t * line.x[1]);
    return (off[0] * there.u + off[1] * there.v).norm() <= 1e-12;
  });
}

std::uint32_t Unfolding::addPlaneCurve(const Handle(Geom_Curve) & curve, const brep::Curve3& record, double t0,
                                       double t1, const gp_Pnt2d& uv, double t, double within, brep::Part& part) {
  const std::vector<Sample> samples = samplesAlong(curve, t0, t1, uv, t, within);
  for (const Sample& s : samples) widen(s.uv);
  const auto index = static_cast<std::uint32_t>(part.curves2.size());
  if (shape_.kind == SurfaceKind::kPlane) {
    part.curves2.push_back(projected(record, shape_, part));
    return index;
  }
  const brep::Curve2 line = lineBetween(samples.front().uv, samples.back().uv, t0, t1);
  const bool straight = follows(line, samples);
  if (!straight && runsToAPole(samples)) throw Unkept("an edge that is no meridian runs to its pole");
  part.curves2.push_back(straight ? line : cubicsThrough(samples, t0, t1, part));
  return index;
}

}  // namespace hapticd::cad
