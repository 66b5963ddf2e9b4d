// SPDX-License-Identifier: MIT
#include "bounds.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

void passivityBounds(const Case& c, Check& check) {
  const Json& in = c.input;
  if (c.expect.contains("c_n")) {
    const auto window = zwidth::windowCoefficient(in["n"].get<int>());
    check.near("c_n", window.value, c.expect["c_n"], number(c.tol["abs"]));
    check.near("theta", window.theta, c.expect["theta"], number(c.tol["theta_abs"]));
    return;
  }
  zwidth::Wall wall;
  wall.damping = number(in["B"]), wall.period = number(in["T"]);
  wall.window = in["n"].get<int>(), wall.delay = in["delay"].get<int>();
  zwidth::Body device;
  device.damping = number(in["b"]);
  const double stiffness = zwidth::maxStiffness(wall, device);
  check.relative("K_max", stiffness, c.expect["K_max"], number(c.tol["rel"]));
}

}  // namespace
HAPTICD_VERIFY(passivity, passivityBounds)
}  // namespace hapticd::verify
