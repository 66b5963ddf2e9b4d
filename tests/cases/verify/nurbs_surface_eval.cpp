// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>

#include "kernels/spline/surface.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

using Eigen::Vector3d;

/// Cases state no tolerance for second derivatives: that of the second derivatives of curves.
constexpr double kSecondRelative = 1e-7;
/// A tangent that is zero, beside one that is not, may keep the rounding of its terms.
constexpr double kRounding = 1e-15;

spline::SurfaceData readSurface(const Json& in) {
  spline::SurfaceData data;
  data.degree = {in["degree_u"].get<int>(), in["degree_v"].get<int>()};
  data.knots = {in["knots_u"].get<std::vector<double>>(), in["knots_v"].get<std::vector<double>>()};
  for (const Json& row : in["points"]) {
    for (const Json& point : row) data.points.push_back(vector(point));
  }
  if (!in.contains("weights") || in["weights"].is_null()) return data;
  for (const Json& row : in["weights"]) {
    for (const Json& weight : row) data.weights.push_back(number(weight));
  }
  return data;
}

/// The outward normal on a collapsed side, from the mixed derivative: Su grows as (v - v0) Suv.
Vector3d limitNormal(const spline::Surface& surface, const spline::SurfacePoint& E, double u, double v) {
  const bool u_collapsed = E.Sv.norm() < E.Su.norm();
  const double at = u_collapsed ? u : v;
  const double side = at <= surface.domain(u_collapsed ? 0 : 1)[0] ? 1 : -1;
  return (side * (u_collapsed ? E.Su.cross(E.Suv) : E.Suv.cross(E.Sv))).normalized();
}

void checkNormal(const Case& c, const spline::Surface& surface, const spline::SurfacePoint& E, Check& check) {
  const double u = number(c.input["u"]), v = number(c.input["v"]), tolerance = number(c.tol["normal_abs"]);
  const Vector3d cross = E.Su.cross(E.Sv);
  if (!c.expect["normal"].is_null()) {
    check.nearVector("normal", Vector3d(cross.normalized()), c.expect["normal"], tolerance);
    return;
  }
  check.isTrue("degenerate", cross.norm() <= kRounding * std::max(E.Su.squaredNorm(), E.Sv.squaredNorm()));
  if (c.expect.contains("limit_outward_normal")) {
    check.nearVector("limit normal", limitNormal(surface, E, u, v), c.expect["limit_outward_normal"], tolerance);
  }
}

void checkForm(const Case& c, const spline::Surface& surface, Check& check) {
  spline::SurfacePoint E;
  surface.evaluate2(number(c.input["u"]), number(c.input["v"]), E);
  const double Su = vector(c.expect["Su"]).norm(), Sv = vector(c.expect["Sv"]).norm();
  const double relative = number(c.tol["Su_rel"]), rounding = kRounding * std::max(Su, Sv);
  const double second = kSecondRelative * std::max({vector(c.expect["Suu"]).norm(), vector(c.expect["Suv"]).norm(),
                                                    vector(c.expect["Svv"]).norm()});
  check.nearVector("S", E.S, c.expect["S"], number(c.tol["S_abs"]));
  check.nearVector("Su", E.Su, c.expect["Su"], std::max(relative * Su, rounding));
  check.nearVector("Sv", E.Sv, c.expect["Sv"], std::max(relative * Sv, rounding));
  check.nearVector("Suu", E.Suu, c.expect["Suu"], second);
  check.nearVector("Suv", E.Suv, c.expect["Suv"], second);
  check.nearVector("Svv", E.Svv, c.expect["Svv"], second);
  checkNormal(c, surface, E, check);
}

void nurbsSurfaceEval(const Case& c, Check& check) {
  const spline::SurfaceData data = readSurface(c.input);
  for (auto form : {spline::Form::kTable, spline::Form::kNet}) {
    for (auto instructions : {spline::Instructions::kFastest, spline::Instructions::kPortable}) {
      checkForm(c, spline::Surface(data, form, instructions), check);
    }
  }
}

}  // namespace
HAPTICD_VERIFY(nurbs_surface_eval, nurbsSurfaceEval)
}  // namespace hapticd::verify
