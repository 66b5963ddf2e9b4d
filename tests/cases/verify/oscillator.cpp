// SPDX-License-Identifier: MIT
#include "kernels/medial/oscillator.hpp"

#include "verify.hpp"

namespace hapticd::verify {
namespace {

void oscillator(const Case& c, Check& check) {
  const Json& in = c.input;
  const medial::Oscillator material{number(in["m"]), number(in["b"]), number(in["k"])};
  const double dt = number(in["dt"]);
  const medial::OscillatorStep step = medial::oscillatorStep(material, dt);
  double x = number(in["x0"]), v = number(in["v0"]);
  const int ticks = in["N"].get<int>();
  for (int i = 0; i < ticks; ++i) step.advance(x, v);
  const double tolerance = number(c.tol["abs_x"]);
  check.near("x", x, c.expect["x"], tolerance);
  // A speed error is a phase error of the position times the angular frequency, or the damping rate if that is faster.
  const double rate = std::fmax(std::sqrt(material.stiffness / material.mass), material.damping / material.mass);
  check.near("v", v, c.expect["v"], tolerance * std::fmax(1, rate));
}

}  // namespace
HAPTICD_VERIFY(oscillator, oscillator)
}  // namespace hapticd::verify
