// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/spline/curve.hpp"
#include "kernels/spline/refinement.hpp"
#include "kernels/trace/model.hpp"
#include "kernels/trace/newton.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

using Eigen::Vector3d;
using spline::Curve;
using spline::CurveData;
using spline::SurfaceData;

CurveData circle(double r) {
  const double w = std::sqrt(0.5);
  CurveData data;
  data.degree = 2;
  data.knots = {0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1};
  data.weights = {1, w, 1, w, 1, w, 1, w, 1};
  for (const auto& [x, y] : {std::pair{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}})
    data.points.emplace_back(r * x, r * y, 0);
  return data;
}

double angleOf(const Vector3d& p) {
  return std::atan2(p.y(), p.x());
}

/// A curve as a surface: ruled along a direction at right angles to it at `u`. There the steps along the two parameters
/// do not mix, and that along the first is the curve's.
SurfaceData ruled(const CurveData& curve, double u) {
  spline::CurvePoint at;
  Curve(curve).evaluate1(u, at);
  const Vector3d aside = 0.5 * at.C1.norm() * at.C1.unitOrthogonal();
  SurfaceData data;
  data.degree = {curve.degree, 1};
  data.knots = {curve.knots, {0, 0, 1, 1}};
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    data.points.push_back(curve.points[i] - aside);
    data.points.push_back(curve.points[i] + aside);
    if (!curve.weights.empty()) data.weights.insert(data.weights.end(), 2, curve.weights[i]);
  }
  return data;
}

struct Stepped {
  double u = 0;
  double lo = 0, hi = 0;  ///< bounds of the patch, to which a step is clamped
};

/// One step of method dpt from a point of a curve, as the tracer takes it.
Stepped stepFrom(const CurveData& curve, double u, const Vector3d& p) {
  const trace::Model model({ruled(curve, u)});
  int index = 0;
  while (index + 1 < model.patchCount() && u > model.patch(index).hi[0]) ++index;
  const trace::Patch& patch = model.patch(index);
  trace::Iterate at;
  at.uv = {u, 0.5};
  trace::LocalFoot foot;
  trace::directFoot(patch, p, at, 1, 2, foot);
  return {foot.uv[0], patch.lo[0], patch.hi[0]};
}

/// Error after one first-order step over the error before it, on a circle with the probe at offset d.
void multiplier(const Case& c, Check& check) {
  const double r = number(c.input["R"]), d = number(c.input["d"]);
  const double u = 0.125, aside = 1e-6;  // in the middle of a span
  spline::CurvePoint at;
  Curve(circle(r)).evaluate1(u, at);
  const double angle = angleOf(at.C) + aside;
  const Vector3d p = (r + d) * Vector3d(std::cos(angle), std::sin(angle), 0);
  spline::CurvePoint there;
  Curve(circle(r)).evaluate1(stepFrom(circle(r), u, p).u, there);
  const double measured = (angleOf(there.C) - angle) / -aside;
  check.relative("multiplier", measured, c.expect["multiplier"], number(c.tol["rel"]));
  check.isTrue("converges", (std::abs(measured) < 1) == c.expect["converges"].get<bool>());
}

/// Eq. 2 and 3 as printed: from the control polygon refined until a control point lies on the curve.
void oneStep(const Case& c, Check& check) {
  CurveData data;
  data.degree = c.input["degree"];
  data.knots = c.input["knots"].get<std::vector<double>>();
  if (c.input.contains("weights") && !c.input["weights"].is_null())
    data.weights = c.input["weights"].get<std::vector<double>>();
  for (const Json& point : c.input["points"])
    data.points.emplace_back(number(point[0]), number(point[1]), number(point[2]));
  const double u = number(c.input["u"]), rel = number(c.tol["rel"]), du = number(c.expect["du"]);
  const Vector3d E(number(c.input["E"][0]), number(c.input["E"][1]), number(c.input["E"][2]));
  const Stepped stepped = stepFrom(data, u, E);
  check.near("du", stepped.u - u, std::clamp(u + du, stepped.lo, stepped.hi) - u, rel * std::abs(du));

  const std::vector<double> added(static_cast<std::size_t>(data.degree), u);
  const CurveData refined = spline::refine(data, added);
  std::size_t span = 0;  // the last knot not beyond u
  while (span + 1 < refined.knots.size() && refined.knots[span + 1] <= u) ++span;
  const std::size_t i = span - static_cast<std::size_t>(refined.degree);
  const Vector3d edge = refined.points[i + 1] - refined.points[i];
  const double range = refined.knots[span + 1] - refined.knots[span];
  const double printed = (E - refined.points[i]).dot(edge) / edge.squaredNorm() * range / refined.degree;
  if (c.expect.contains("du_eq3_as_printed")) check.relative("printed", printed, c.expect["du_eq3_as_printed"], rel);
  if (c.expect.contains("weight_ratio") && !refined.weights.empty())
    check.relative("ratio", refined.weights[i + 1] / refined.weights[i], c.expect["weight_ratio"], rel);
}

void dpt(const Case& c, Check& check) {
  c.input.contains("knots") ? oneStep(c, check) : multiplier(c, check);
}

}  // namespace
HAPTICD_VERIFY(dpt, dpt)
}  // namespace hapticd::verify
