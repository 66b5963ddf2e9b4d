// SPDX-License-Identifier: MIT
#include "kernels/medial/influence.hpp"
#include "kernels/spline/basis.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

void splineDeform(const Case& c, Check& check) {
  const Json& in = c.input;
  const int degree = in["degree"].get<int>();
  const auto knots = in["knots"].get<std::vector<double>>();
  const double t = number(in["t"]), d = number(in["d"]);
  std::array<double, spline::kMaxDegree + 1> basis{};
  const int span = spline::findSpan(knots, degree, t);
  spline::basisFunctions(knots, degree, span, t, basis);
  const medial::Influence moved = medial::influence(std::span(basis).first(static_cast<std::size_t>(degree) + 1), span,
                                                    in["p_prime"].get<int>(), medial::PointSelection::kCentral);
  check.isTrue("first", moved.first == c.expect["first"].get<int>());
  check.isTrue("last", moved.first + moved.count - 1 == c.expect["last"].get<int>());
  double sum = 0;
  for (std::size_t i = 0; i < c.expect["alpha"].size() && i < moved.alpha.size(); ++i) {
    check.relative("alpha", d * moved.alpha[i], c.expect["alpha"][i], number(c.tol["rel"]));
    sum += d * moved.alpha[i] * moved.basis[i];
  }
  check.near("sum_alpha_B", sum, c.expect["sum_alpha_B"], number(c.tol["moved_abs"]));
}

}  // namespace
HAPTICD_VERIFY(spline_deform, splineDeform)
}  // namespace hapticd::verify
