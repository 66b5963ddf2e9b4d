// SPDX-License-Identifier: MIT
#include <cmath>

#include "kernels/spline/refinement.hpp"
#include "kernels/trace/curve_foot.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

using Eigen::Vector3d;
using spline::Curve;
using spline::CurveData;

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

/// Error after one first-order step over the error before it, on a circle with the probe at offset d.
void multiplier(const Case& c, Check& check) {
  const double r = number(c.input["R"]), d = number(c.input["d"]);
  const Curve curve(circle(r));
  const double u = 0.125, aside = 1e-6;  // in the middle of a span
  spline::CurvePoint at;
  curve.evaluate1(u, at);
  const double angle = angleOf(at.C) + aside;
  const Vector3d p = (r + d) * Vector3d(std::cos(angle), std::sin(angle), 0);
  const trace::CurveFoot foot = trace::directFoot(curve, p, u, 1);
  const double measured = (angleOf(foot.point) - angle) / -aside;
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
  const double u = number(c.input["u"]), rel = number(c.tol["rel"]);
  const Vector3d E(number(c.input["E"][0]), number(c.input["E"][1]), number(c.input["E"][2]));
  spline::CurvePoint at;
  Curve(data).evaluate1(u, at);
  check.relative("du", trace::directStep(at, E), c.expect["du"], rel);

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
