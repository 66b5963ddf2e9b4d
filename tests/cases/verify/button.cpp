// SPDX-License-Identifier: MIT
#include "kernels/dynamics/button.hpp"

#include "verify.hpp"

namespace hapticd::verify {
namespace {

using dynamics::DetentCurve;

void constantSprings(const Case& c, Check& check) {
  const Json& in = c.input;
  const DetentCurve detent({}, number(in["k2"]));
  const auto found = dynamics::buttonEquilibria(number(in["k1"]), detent, number(in["x_travel"]));
  if (found.count != 1) return check.fail("expected one equilibrium");
  const double tolerance = number(c.tol["rel"]);
  check.relative("F", found.at[0].force, c.expect["F"], tolerance);
  check.relative("x1", found.at[0].x1, c.expect["x1"], tolerance);
  check.relative("x2", found.at[0].x2, c.expect["x2"], tolerance);
}

void button(const Case& c, Check& check) {
  const Json& in = c.input;
  if (!in.contains("detent")) return constantSprings(c, check);
  std::vector<DetentCurve::Knot> knots;
  for (const Json& knot : in["detent"]) knots.push_back({number(knot[0]), number(knot[1])});
  const DetentCurve detent(knots, number(in["k_end"]));
  for (size_t i = 0; i < in["x_travel"].size(); ++i) {
    const auto found = dynamics::buttonEquilibria(number(in["k1"]), detent, number(in["x_travel"][i]));
    const Json& expected = c.expect["equilibria"][i];
    if (found.count != static_cast<int>(expected.size())) return check.fail("number of equilibria");
    for (size_t n = 0; n < expected.size(); ++n) {
      check.near("F", found.at[n].force, expected[n]["F"], number(c.tol["F_abs"]));
      check.near("x1", found.at[n].x1, expected[n]["x1"], number(c.tol["x_abs"]));
      check.near("x2", found.at[n].x2, expected[n]["x2"], number(c.tol["x_abs"]));
    }
  }
}

}  // namespace
HAPTICD_VERIFY(button, button)
}  // namespace hapticd::verify
