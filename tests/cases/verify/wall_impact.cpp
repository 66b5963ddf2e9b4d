// SPDX-License-Identifier: MIT
#include "kernels/contact/wall.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

struct Impact {
  double restitution = 0, deepest = 0, time = 0;
};

/// A free mass against the production wall, x0 = 1 m (Eq. 4 as printed), by Runge-Kutta of fourth order: only the
/// wall's force is asked. Steps shrink with the depth, for n < 1 the force rises with infinite slope.
Impact hit(double mass, const contact::WallLaw& law, double speed) {
  Impact impact;
  const double scale =
      std::pow((law.exponent + 1) * mass * speed * speed / (2 * law.stiffness), 1 / (law.exponent + 1));
  const auto acceleration = [&](double x, double v) { return -contact::wallForce(law, x, v).force / mass; };
  double x = 0, v = speed;
  constexpr long kMaxSteps = 20'000'000;
  for (long i = 0; i < kMaxSteps && x >= 0; ++i) {
    const double h = std::min(1e-6, 1e-4 * (x + 1e-4 * scale) / speed);
    const double a1 = acceleration(x, v), v2 = v + h / 2 * a1;
    const double a2 = acceleration(x + h / 2 * v, v2), v3 = v + h / 2 * a2;
    const double a3 = acceleration(x + h / 2 * v2, v3), v4 = v + h * a3;
    const double a4 = acceleration(x + h * v3, v4);
    const double next = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    impact.time += next < 0 ? h * x / (x - next) : h;
    x = next;
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    impact.deepest = std::max(impact.deepest, x);
  }
  impact.restitution = -v / speed;
  return impact;
}

void wallImpact(const Case& c, Check& check) {
  const Json& in = c.input;
  const contact::WallLaw law{number(in["k"]), number(in["lam"]), number(in["n"]), 1};
  const Impact impact = hit(number(in["m"]), law, number(in["v_in"]));
  const auto tolerance = [&](const char* key) { return c.tol.contains(key) ? number(c.tol[key]) : 1e-4; };
  check.near("restitution", impact.restitution, c.expect["restitution"], tolerance("restitution_abs"));
  check.relative("x_max", impact.deepest, c.expect["x_max"], tolerance("x_max_rel"));
  if (c.expect.contains("contact_time"))
    check.relative("contact_time", impact.time, c.expect["contact_time"], tolerance("contact_time_rel"));
}

}  // namespace
HAPTICD_VERIFY(wall_impact, wallImpact)
}  // namespace hapticd::verify
