// SPDX-License-Identifier: MIT
#include "kernels/dynamics/pendulum.hpp"

#include "verify.hpp"

namespace hapticd::verify {
namespace {

using dynamics::PendulumLaw;
using dynamics::PendulumState;

constexpr double kStep = 1.0 / 1500;  // the note of the cases

PendulumState swing(const PendulumLaw& law, double angle, double time) {
  PendulumState state{angle, 0};
  const int ticks = static_cast<int>(std::ceil(time / kStep));
  for (int i = 0; i < ticks; ++i) state = dynamics::advance(law, state, 0, time / ticks);
  return state;
}

PendulumLaw lawOf(const Json& in) {
  PendulumLaw law;
  if (in.contains("w0")) {  // damped: w0^2 = m g L / I with m = L = I = 1
    law.gravity = number(in["w0"]) * number(in["w0"]);
    law.damping = number(in["c"]);
    return law;
  }
  law.gravity = number(in["g"]);
  law.length = number(in.contains("L") ? in["L"] : in["length"]);
  if (in.contains("mass")) law.mass = number(in["mass"]);
  law.inertia = in.contains("inertia") ? number(in["inertia"]) : law.mass * law.length * law.length;
  return law;
}

void pendulum(const Case& c, Check& check) {
  const PendulumLaw law = lawOf(c.input);
  const double angle = number(c.input["theta0"]);
  const bool absolute = c.tol.contains("abs");
  const double tolerance = number(absolute ? c.tol["abs"] : c.tol["rel"]);
  if (c.expect.contains("period"))
    check.relative("period", dynamics::period(law, angle), c.expect["period"], tolerance);
  if (c.expect.contains("separatrix_rate"))  // the rate at the bottom with which it just reaches the top
    check.relative("separatrix", dynamics::energy(law, {M_PI, 0}),
                   dynamics::energy(law, {0, number(c.expect["separatrix_rate"])}), tolerance);
  if (!c.input.contains("t")) return;
  const PendulumState state = swing(law, angle, number(c.input["t"]));
  // angle and rate pass through 0, where only the amplitude is a scale
  const double angle_scale = absolute ? 1 : std::fabs(angle);
  const double rate_scale = absolute ? 1 : std::sqrt(law.frequencySquared()) * std::fabs(angle);
  if (c.expect.contains("theta")) check.near("theta", state.angle, c.expect["theta"], tolerance * angle_scale);
  if (c.expect.contains("omega")) check.near("omega", state.rate, c.expect["omega"], tolerance * rate_scale);
}

}  // namespace
HAPTICD_VERIFY(pendulum, pendulum)
}  // namespace hapticd::verify
