// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <cmath>

#include "kernels/trace/tracer.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

using Eigen::Vector3d;
using spline::SurfaceData;

/// Homogeneous control point: position and weight.
struct Weighted {
  double x, y, w;
};

/// The exact circle of nine points about the origin.
std::vector<Weighted> circle() {
  const double w = std::sqrt(0.5);
  return {{1, 0, 1}, {1, 1, w}, {0, 1, 1}, {-1, 1, w}, {-1, 0, 1}, {-1, -1, w}, {0, -1, 1}, {1, -1, w}, {1, 0, 1}};
}
const std::vector<double> kCircleKnots = {0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1};

/// Turns a profile of (radius, height, weight) about z; outward where the profile goes up on the outside.
SurfaceData revolve(const std::vector<Weighted>& profile, int degree, const std::vector<double>& knots) {
  SurfaceData data;
  data.degree = {2, degree};
  data.knots = {kCircleKnots, knots};
  for (const Weighted& c : circle())
    for (const Weighted& p : profile) {
      data.points.emplace_back(p.x * c.x, p.x * c.y, p.y);
      data.weights.push_back(c.w * p.w);
    }
  return data;
}

SurfaceData sphere(double r, const Vector3d& center) {
  const double w = std::sqrt(0.5);
  SurfaceData data =
      revolve({{0, -r, 1}, {r, -r, w}, {r, 0, 1}, {r, r, w}, {0, r, 1}}, 2, {0, 0, 0, 0.5, 0.5, 1, 1, 1});
  for (Vector3d& point : data.points) point += center;
  return data;
}

SurfaceData torus(double big, double small) {
  std::vector<Weighted> profile;
  for (const Weighted& c : circle()) profile.push_back({big + small * c.x, small * c.y, c.w});
  return revolve(profile, 2, kCircleKnots);
}

SurfaceData cylinder(double r, double z) {
  return revolve({{r, z - 1, 1}, {r, z + 1, 1}}, 1, {0, 0, 1, 1});
}

/// A square of the plane that holds every foot of a probe `reach` away from o.
SurfaceData plane(const Vector3d& o, const Vector3d& n, double reach) {
  const Vector3d e3 = n.normalized(), e1 = e3.unitOrthogonal(), e2 = e3.cross(e1);
  SurfaceData data;
  data.knots = {{{0, 0, 1, 1}, {0, 0, 1, 1}}};
  for (int i = -1; i <= 1; i += 2)
    for (int j = -1; j <= 1; j += 2) data.points.push_back(o + reach * (i * e1 + j * e2));
  return data;
}

/// z = k (x^2 + y^2) over |x|, |y| <= reach: exact as a biquadratic patch.
SurfaceData paraboloid(double k, double reach) {
  SurfaceData data;
  data.degree = {2, 2};
  data.knots = {{{0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1}}};
  const auto square = [&](int i) { return i == 1 ? -reach * reach : reach * reach; };  // Bezier ordinates of t^2
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) data.points.emplace_back((i - 1) * reach, (j - 1) * reach, k * (square(i) + square(j)));
  return data;
}

SurfaceData bezier(const Json& rows) {
  SurfaceData data;
  data.degree = {3, 3};
  data.knots = {{{0, 0, 0, 0, 1, 1, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}}};
  for (const Json& row : rows)
    for (const Json& point : row) data.points.push_back(vector(point));
  return data;
}

SurfaceData surfaceOf(const Json& in, const Vector3d& q) {
  const std::string shape = in["shape"];
  if (shape == "sphere") return sphere(number(in["radius"]), vector(in["center"]));
  if (shape == "cylinder_z") return cylinder(number(in["radius"]), q.z());
  if (shape == "torus_z") return torus(number(in["A"]), number(in["a"]));
  if (shape == "plane") return plane(vector(in["o"]), vector(in["n"]), 2 * (q - vector(in["o"])).norm());
  if (shape == "paraboloid") return paraboloid(number(in["k"]), q.norm() + 1);
  if (shape == "bicubic_bezier") return bezier(in["points"]);
  throw std::invalid_argument("unknown shape " + shape);
}

/// Global search, then one tick of the tracer from there, as in the servo loop.
void closestPoint(const Case& c, Check& check) {
  const Vector3d q = vector(c.input["Q"]);
  const trace::Model model({surfaceOf(c.input, q)});
  trace::Near near;
  if (model.nearby(q, 1e3, &near, 1) != 1) return check.fail("nothing nearby");
  trace::Tracer tracer(model);
  tracer.activate(0, near.u, near.v, near.distance);
  trace::TraceOptions options;
  options.tolerance = 1e-15;
  const trace::Foot foot = tracer.step(q, options);
  check.isTrue("traced", foot.status != trace::FootStatus::kInvalid && foot.surface == 0);
  const Json &expect = c.expect, &tol = c.tol;
  if (expect.contains("distance")) check.near("distance", foot.distance, expect["distance"], number(tol["dist_abs"]));
  if (expect.contains("signed_distance"))
    check.near("signed_distance", -foot.depth, expect["signed_distance"], number(tol["dist_abs"]));
  if (expect.contains("foot") && tol.contains("foot_abs"))
    check.nearVector("foot", foot.point, expect["foot"], number(tol["foot_abs"]));
  if (expect.contains("normal") && tol.contains("foot_abs"))
    check.nearVector("normal", foot.normal, expect["normal"], 10 * number(tol["foot_abs"]));
  if (expect.contains("u") && tol.contains("uv_abs")) {
    check.near("u", foot.u, expect["u"], number(tol["uv_abs"]));
    check.near("v", foot.v, expect["v"], number(tol["uv_abs"]));
  }
}

}  // namespace
HAPTICD_VERIFY(closest_point, closestPoint)
}  // namespace hapticd::verify
