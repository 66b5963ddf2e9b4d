// SPDX-License-Identifier: MIT
#include "kernels/spline/curve.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

double norm(const Json& vector) {
  double sum = 0;
  for (const Json& component : vector) sum += number(component) * number(component);
  return std::sqrt(sum);
}

spline::CurveData readCurve(const Json& in) {
  spline::CurveData data;
  data.degree = in["degree"].get<int>();
  data.knots = in["knots"].get<std::vector<double>>();
  for (const Json& point : in["points"]) {
    data.points.emplace_back(number(point[0]), number(point[1]), point.size() > 2 ? number(point[2]) : 0);
  }
  if (in.contains("weights") && !in["weights"].is_null()) data.weights = in["weights"].get<std::vector<double>>();
  return data;
}

/// Positions absolutely, derivatives relative to the length of the true vector; a derivative that is zero must be zero.
void nurbsCurveEval(const Case& c, Check& check) {
  const spline::CurveData data = readCurve(c.input);
  for (const auto form : {spline::Form::kNet, spline::Form::kTable})
    for (auto instructions : {spline::Instructions::kFastest, spline::Instructions::kPortable}) {
      const spline::Curve curve(data, form, instructions);
      spline::CurvePoint E;
      curve.evaluate2(number(c.input["u"]), E);
      check.nearVector("C", E.C, c.expect["C"], number(c.tol["C_abs"]));
      check.nearVector("C1", E.C1, c.expect["C1"], number(c.tol["C1_rel"]) * norm(c.expect["C1"]));
      check.nearVector("C2", E.C2, c.expect["C2"], number(c.tol["C2_rel"]) * norm(c.expect["C2"]));
    }
}

}  // namespace
HAPTICD_VERIFY(nurbs_curve_eval, nurbsCurveEval)
}  // namespace hapticd::verify
